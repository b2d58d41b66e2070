"""Tree → document: an edited script drawn over the document that people had before."""
