"""`python -m vipo_site.demo`: run everything on this machine."""

from vipo_site.demo.main import main

main()
