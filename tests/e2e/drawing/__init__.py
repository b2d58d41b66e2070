"""Drawing in the editor: what it takes to begin, keys, fields, frames and the bar above."""
