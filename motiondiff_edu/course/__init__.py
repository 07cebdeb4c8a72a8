"""What only notebooks use: profile and seed, exercise checks and their bug zoo, doctor, lab and
demo."""
