"""What every front end shows and binds, without any toolkit."""
