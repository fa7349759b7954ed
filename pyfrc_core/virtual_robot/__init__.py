"""A virtual robot: an SSH server on this computer that runs the deploy agent and starts the deployed program."""
