"""The registry over HTTP and its site socket."""
