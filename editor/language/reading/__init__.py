"""Document → tree: what people drew, read into typed nodes."""
