"""What was done at a site: by whom, when and from where, written with the change itself and never changed after."""
