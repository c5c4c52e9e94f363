"""Random scenes, files and scripts whose right answers are known without the core."""
