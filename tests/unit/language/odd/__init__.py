"""Scripts made by chance, and what is told of them."""
