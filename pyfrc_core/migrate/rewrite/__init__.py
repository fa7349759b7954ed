"""What a file becomes: edits of its tree, made by what its expressions are."""
