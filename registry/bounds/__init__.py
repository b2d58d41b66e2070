"""How much of a thing that costs much may go on at once, for one person, one site and in all."""
