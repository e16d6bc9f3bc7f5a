"""Where output goes: staged folders, progress, time stamp."""
