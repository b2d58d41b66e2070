"""A site's devices as a W3C Thing directory: pages, answers, events."""
