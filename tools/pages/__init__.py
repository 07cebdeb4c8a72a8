"""The course as web pages: `make pages` runs every notebook and writes build/pages.

Each page works without a network and without a server: formulas are MathML, players and pictures
are in the page, and what needs a kernel says so.
"""
