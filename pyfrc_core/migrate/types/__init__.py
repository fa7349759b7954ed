"""What each expression of a project is: of WPILib, by its path, or the team's own."""
