"""Every form of a description, in and out: RDF, Thing Description, the paper's message. RDF libraries only here."""
