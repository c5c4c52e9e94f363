"""Random scenes, files and scripts whose correct results are known without the core."""
