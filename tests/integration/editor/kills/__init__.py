"""What was called saved outlives the death of the process that said so."""
