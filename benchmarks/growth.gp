# Time and memory over the size of the mesh, from a CSV of benchmarks/simplifiers:
#
#   gnuplot -e "csv='growth.csv'; svg='growth.svg'" benchmarks/growth.gp
set terminal svg size 1040,470 enhanced font 'sans-serif,13' background '#ffffff'
set output svg
set datafile separator ','
set datafile missing NaN
set multiplot layout 1,2
set logscale xy
set grid xtics ytics lc rgb '#b0b0b0' lw 0.6
set format x '%.0s %c'
set format y '%g'
set xlabel 'vertices of the input'
set key bottom right font ',11' noenhanced

methods = 'planes distance-fast distance cgal meshopt'
colours = '#0072b2 #000000 #d55e00 #e69f00 #009e73'
only(m, x) = strcol('method') eq m ? x : NaN

# n log n through the smallest mesh of the first method that is there.
first = ''
do for [i = 1:words(methods)] {
  stats csv using (only(word(methods, i), column('seconds'))) nooutput
  if (first eq '' && STATS_records > 0) { first = word(methods, i) }
}
stats csv using (only(first, column('vertices_in'))):(only(first, column('seconds'))) nooutput
n0 = STATS_min_x
t0 = STATS_min_y

set title 'User CPU time of the simplification to 5 %, one thread'
set ylabel 'seconds'
plot for [i = 1:words(methods)] csv using (column('vertices_in')):(only(word(methods, i), column('seconds'))) \
       with linespoints lw 1.8 pt 7 ps 0.6 lc rgb word(colours, i) title word(methods, i), \
     t0 * x * log(x) / (n0 * log(n0)) with lines dt 3 lc rgb '#808080' title 'n log n'

set title 'Peak memory of the process'
set ylabel 'MB'
stats csv using (only(first, column('vertices_in'))):(only(first, column('peak_megabytes'))) nooutput
plot for [i = 1:words(methods)] csv using (column('vertices_in')):(only(word(methods, i), column('peak_megabytes'))) \
       with linespoints lw 1.8 pt 7 ps 0.6 lc rgb word(colours, i) title word(methods, i), \
     STATS_max_y * x / STATS_max_x with lines dt 3 lc rgb '#808080' title 'n'
unset multiplot
