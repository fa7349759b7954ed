"""What became of each of WPILib's names: a table made from the packages of both seasons, and corrections by hand."""
