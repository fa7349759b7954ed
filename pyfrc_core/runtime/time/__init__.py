"""What WPILib does by itself while a robot runs, in robot time.

In: the clock and the robot. Out: its periodic functions are called when they are due, its motors are checked, and its
own simulation sees what physics sees.
"""
