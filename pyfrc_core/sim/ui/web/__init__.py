"""The simulator in a browser: `front_end` serves a page, and `page_file` writes one that needs no server."""
