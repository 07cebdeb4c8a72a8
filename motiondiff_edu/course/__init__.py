"""What turns the library into a course.

Profile and seed, the checks of the exercises and their bug zoo, analyses that single notebooks
show, doctor, lab and demo.
"""
