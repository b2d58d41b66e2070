"""What is said to people about programs and scripts: the sentences of diagnostics in every language."""
