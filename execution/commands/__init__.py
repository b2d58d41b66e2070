"""Commands to devices: which may go out now, what devices answer, and what people tell them by hand."""
