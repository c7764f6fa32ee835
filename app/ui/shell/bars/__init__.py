"""What stands round the views: menus and keys, bars, command line, badge."""
