"""Optimisers and policies on the same wings with equal budgets."""
