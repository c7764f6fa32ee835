"""Reading and writing: drawings, projects, NC programs, sheets, pictures beneath the drawing."""
