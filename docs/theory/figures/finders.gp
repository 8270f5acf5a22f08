# The pictures of ../finders.md, from the relative epicycle itself: no simulation, no data files.
# In this folder: gnuplot finders.gp
set encoding utf8
set samples 241
set key noenhanced samplen 2
set border 3 lw 0.8
set tics nomirror out scale 0.5
set style line 1 lc rgb "#1b4f8a" lw 2
set style line 2 lc rgb "#b5442e" lw 2
set style line 3 lc rgb "#777777" lw 1.5 dt 2
set style line 4 lc rgb "#2e7d4f" lw 1.5
R = 2.0   # the sum of the radii
S = 1.5   # shear rate, κ = 1

# Relative orbit: guiding centre X, Y, eccentricity vector (a, b), inclination vector (p, q), vertical frequency n.
ec(t) = a*cos(t) - b*sin(t)
es(t) = b*cos(t) + a*sin(t)
x(t) = X - ec(t)
y(t) = Y - S*X*t + 2*es(t)
z(t) = p*cos(n*t) + q*sin(n*t)
vx(t) = es(t)
vy(t) = 2*ec(t) - S*X
vz(t) = n*(q*cos(n*t) - p*sin(n*t))
d2(t) = x(t)**2 + y(t)**2 + z(t)**2
v2(t) = vx(t)**2 + vy(t)**2 + vz(t)**2
f(t) = d2(t) - R**2
slope(t) = 2*(x(t)*vx(t) + y(t)*vy(t) + z(t)*vz(t))
p = 0; q = 0; n = 1

# --- Figure 2 of the paper: d − R for a solid hit, a graze and a miss
set terminal svg size 560,300 font "sans,12" background "white"
set output "hit-graze-miss.svg"
X = 0; a = 0; b = -12
gap(t, closest) = (Y = closest - 2*b, sqrt(d2(t)) - R)
set xrange [-0.3:0.3]; set yrange [-2:3]
set xlabel "t, rad"; set ylabel "d − R, radii"
set xzeroaxis ls 3
set key top center horizontal
plot gap(x, 0.6) ls 1 title "solid hit", gap(x, 1.93) ls 2 title "graze", gap(x, 2.6) ls 4 title "miss"

# --- Newton passes the first contact: the tangent leads over it
set output "newton-jump.svg"
X = -1.075; Y = -4.593; a = 0.251; b = 2.198; p = 1.722; q = 2.907; n = 3.6
t0 = -0.2*pi; t1 = t0 - f(t0)/slope(t0); t2 = t1 - f(t1)/slope(t1)
set xrange [-0.65:0.65]; set yrange [-4:20]
set ylabel "f = |d|² − R²"
set key top right
set label 1 "first contact" at -0.3,-1.5 center font ",11"
set label 2 "found" at 0.5,-1.5 center font ",11"
plot f(x) ls 1 title "f", (x < t1 ? f(t0) + slope(t0)*(x - t0) : NaN) ls 2 title "tangent at the start", \
     '+' using (t0):(f(t0)) every ::0::0 with points pt 7 lc rgb "#b5442e" title "guesses", \
     '+' using (t1):(f(t1)) every ::0::0 with points pt 7 lc rgb "#b5442e" notitle, \
     '+' using (t2):(f(t2)) every ::0::0 with points pt 7 lc rgb "#b5442e" notitle
unset label

# --- the linear search ends at a closest approach; the path turns and touches
set terminal svg size 720,330 font "sans,12" background "white"
set output "linear-stuck.svg"
X = -3.391; Y = 1.38; a = -3.821; b = 0.719; p = 0; q = 0; n = 1
t0 = -0.2*pi; t9 = 0.2*pi
closest = t0 - 0.5*slope(t0)/v2(t0)
set multiplot layout 1,2
set parametric
unset xzeroaxis
unset key
set size ratio -1
set trange [0:1]
set xrange [-3.1:3.1]; set yrange [-2.1:4.5]
set xlabel "x, radii"; set ylabel "y, radii"
along(u) = t0 + u*(t9 - t0)
set label 1 "start" at x(t0)-0.15,y(t0)+0.05 right font ",11"
set label 2 "straight line" at 0.9,3.75 font ",11" tc rgb "#b5442e"
set label 3 "path" at 0.65,2.3 font ",11" tc rgb "#1b4f8a"
set label 4 "next guess" at 0.0,3.3 right font ",11"
set label 5 "R" at -1.35,-0.9 center font ",11"
set label 6 "√2 R" at -2.6,1.5 center font ",11"
plot R*cos(2*pi*t),R*sin(2*pi*t) with filledcurves lc rgb "#e4e4e4", \
     sqrt(2)*R*cos(2*pi*t),sqrt(2)*R*sin(2*pi*t) ls 3, \
     x(along(t)),y(along(t)) ls 1, \
     x(t0)+vx(t0)*t*1.3*(closest-t0),y(t0)+vy(t0)*t*1.3*(closest-t0) ls 2, \
     '+' using (x(t0)+vx(t0)*(closest-t0)):(y(t0)+vy(t0)*(closest-t0)) every ::0::0 with points pt 6 lc rgb "#b5442e", \
     '+' using (x(closest)):(y(closest)) every ::0::0 with points pt 7 lc rgb "#b5442e"
unset label
unset parametric
set size noratio
set xzeroaxis ls 3
set xrange [-0.65:0.65]; set yrange [-4:14]
set xlabel "t, rad"; set ylabel "f = |d|² − R²"
set label 1 "straight line" at 0.1,12.6 right font ",11" tc rgb "#b5442e"
set label 2 "f" at 0.2,2.6 font ",11" tc rgb "#1b4f8a"
set label 3 "d² = 2 R²" at 0.63,4.7 right font ",11"
set label 4 "next guess" at -0.3,6.9 right font ",11"
line(t) = (x(t0)+vx(t0)*(t-t0))**2 + (y(t0)+vy(t0)*(t-t0))**2 - R**2
plot f(x) ls 1, line(x) ls 2, R**2 ls 3, \
     '+' using (closest):(f(closest)) every ::0::0 with points pt 7 lc rgb "#b5442e"
unset label
unset multiplot

# --- a tangent that stays clear of contact, a path that does not, and the allowance A t²/2
set terminal svg size 420,420 font "sans,12" background "white"
set output "tangent.svg"
X = -3.167; Y = 9.355; a = -6.47; b = -3.787
half = 0.4; A = 2*sqrt(a*a + b*b)
set parametric
set size ratio -1
set trange [0:1]
set xrange [-2.4:5.2]; set yrange [-2.6:5.4]
set xlabel "x, radii"; set ylabel "y, radii"
along(u) = half*(2*u - 1)
tx(t) = x(0) + vx(0)*t
ty(t) = y(0) + vy(0)*t
set for [k=1:5] object k circle at first tx(half*k/5),ty(half*k/5) size first 0.5*A*(half*k/5)**2 fc rgb "#999999" fs empty border lw 0.8 front
set label 1 "mid-step" at x(0)+0.2,y(0)-0.1 font ",11"
set label 2 "path" at 4.05,4.7 right font ",11" tc rgb "#1b4f8a"
set label 3 "tangent" at 4.0,2.8 font ",11" tc rgb "#b5442e"
set label 4 "½ A t²" at 3.05,-0.9 font ",11" tc rgb "#777777"
set label 5 "R" at 0,0 center font ",11"
unset xzeroaxis
unset key
plot R*cos(2*pi*t),R*sin(2*pi*t) with filledcurves lc rgb "#e4e4e4", \
     x(along(t)),y(along(t)) ls 1, tx(along(t)),ty(along(t)) ls 2
unset label; unset object; unset parametric; set size noratio
set xzeroaxis ls 3

# --- certified steps: parabolas that f cannot undercut
set terminal svg size 560,300 font "sans,12" background "white"
set output "certified.svg"
X = -3.391; Y = 1.38; a = -3.821; b = 0.719
e = sqrt(a*a + b*b); V = S*abs(X) + 2*e; A = 2*e
array T[12]; array M[12]; array H[12]
t = t0
do for [k=1:12] {
  s = t9 - t
  w = sqrt(v2(t)) - A*s
  T[k] = t
  M[k] = 2*(w > 0 ? w*w : 0) - 2*(sqrt(d2(t)) + V*s)*A
  root = sqrt(slope(t)**2 - 2*M[k]*f(t))
  H[k] = slope(t) < 0 ? 2*f(t)/(root - slope(t)) : (slope(t) + root)/(-M[k])
  t = t + H[k]
}
set xrange [-0.65:0.65]; set yrange [-4:16]
set xlabel "t, rad"; set ylabel "f = |d|² − R²"
set key on top right
parabola(t, k) = t < T[k] || t > T[k] + H[k] ? NaN : f(T[k]) + slope(T[k])*(t - T[k]) + 0.5*M[k]*(t - T[k])**2
set samples 601
plot f(x) ls 1 title "f", for [k=1:12] parabola(x, k) ls 2 lw 1.2 title (k == 1 ? "lower bounds" : ""), \
     for [k=1:12] '+' using (T[k]):(f(T[k])) every ::0::0 with points pt 7 ps 0.5 lc rgb "#b5442e" notitle
