"""A site's floor as other fleet managers read it: its places, and the roads that robots drive between them."""
