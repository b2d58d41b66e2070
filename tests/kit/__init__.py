"""What tests of several rooms use: servers, clients, made sites, devices and programs, each written once."""
