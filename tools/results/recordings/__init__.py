"""What holds on recordings of people, whom no training has seen."""
