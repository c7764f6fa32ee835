"""What a job can ask for, one folder a kind of operation."""
