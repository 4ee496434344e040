"""What agents are trained for: one file a task, each with its environment and its own way to judge a policy."""
