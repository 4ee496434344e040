"""The explorer: a page on this machine alone, on which one moves a stroke and sees what it costs; extra "explore"."""
