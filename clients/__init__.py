"""Learners of other projects on the environments as they are; docs/clients.md says how to run them."""
