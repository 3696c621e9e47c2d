# Adds slowly changing errors to a trajectory (TUM): awk -v seed=N -v kind=smooth -f erring-truth.awk T.tum
# Errors of x and y have the standard deviation `sigma` (0.15 m), those of the heading `turn` (0.3 deg). They are
# correlated over `reach` (100 m) of path: kind=smooth, with exp(-s^2 / (2 reach^2)) (a sum of cosines);
# kind=rough, with exp(-s / reach) (a Gauss-Markov process). Random numbers are those of Park and Miller.
function uniform() {
  state = (state * 16807) % 2147483647
  return state / 2147483647
}
function normal() { return sqrt(-2 * log(uniform())) * cos(6.283185307179586 * uniform()) }
BEGIN {
  if (sigma == "") sigma = 0.15
  if (turn == "") turn = 0.3
  if (reach == "") reach = 100
  if (kind != "smooth" && kind != "rough") {
    print "erring-truth.awk: kind is smooth or rough" >"/dev/stderr"
    exit 1
  }
  state = 1 + (seed * 7919 + 12345) % 2147483646
  for (i = 0; i < 20; ++i) uniform()
  waves = 24
  for (c = 1; c <= 3; ++c) {
    error[c] = normal()
    for (k = 1; k <= waves; ++k) {
      frequency[c, k] = normal() / reach
      phase[c, k] = 6.283185307179586 * uniform()
    }
  }
}
/^#/ { next }
{
  step = rows++ ? sqrt(($2 - x) ^ 2 + ($3 - y) ^ 2) : 0
  along += step
  x = $2
  y = $3
  kept = exp(-step / reach)
  for (c = 1; c <= 3; ++c) {
    if (kind == "rough") {
      error[c] = kept * error[c] + sqrt(1 - kept * kept) * normal()
      continue
    }
    error[c] = 0
    for (k = 1; k <= waves; ++k) error[c] += sqrt(2 / waves) * cos(frequency[c, k] * along + phase[c, k])
  }
  yaw = 2 * atan2($7, $8) + error[3] * turn * 3.141592653589793 / 180
  printf "%s %.6f %.6f %s 0 0 %.9f %.9f\n", $1, x + sigma * error[1], y + sigma * error[2], $4, sin(yaw / 2), cos(yaw / 2)
}
