"""What only the course uses: the commands lab, demo and doctor, and the notebooks they open."""
