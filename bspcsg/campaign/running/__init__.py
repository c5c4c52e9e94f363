"""Run cases on workers: child processes, local pools and clusters."""
