"""The films of the five texts: stages of 1986, figure 11 of 1999, the dies of the measurements."""
