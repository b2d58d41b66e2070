"""Reviews: what a site demands before a program may run on its devices, who has approved which content, the gate."""
