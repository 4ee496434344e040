"""The benchmark of the learners: runs in processes of their own, kept numbers, tables and pictures."""
