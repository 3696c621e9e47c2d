# True poles of a simulated street (poles_gt.csv) to an inventory as a city might have it: x,y in metres.
# -v seed=N. Each place is off by 0.3 to 1 m, 20 % of the poles are missing, and 10 % more exist in the inventory
# only, within 15 m of a true one.
BEGIN { FS = ","; OFS = ","; srand(seed); print "x", "y" }
NR == 1 {
  for (i = 1; i <= NF; ++i) column[$i] = i
  next
}
{
  x = $column["x"]; y = $column["y"]
  direction = 6.2831853 * rand(); distance = 0.3 + 0.7 * rand()
  if (rand() > 0.2) printf "%.4f,%.4f\n", x + distance * cos(direction), y + distance * sin(direction)
  if (rand() < 0.1) printf "%.4f,%.4f\n", x + 30 * rand() - 15, y + 30 * rand() - 15
}
