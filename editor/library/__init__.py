"""The library of functions over sites: saved, found, compared, fitted to devices, made anew at other sites."""
