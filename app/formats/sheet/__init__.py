"""The sheet that goes to the machine with a program: on A4 as PDF, and as one page of HTML."""
