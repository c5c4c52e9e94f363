"""Cases on workers: processes, pools and clusters."""
