(Part plate)
(Hitofude for grbl, lengths in mm)
(File 2 of 2, with T2 alone, X and Y zero as in the others)
(Set Z zero with this tool in the spindle)
(Stock 44 mm x 34 mm x 8 mm)
(Work origin: lower left of stock, top of stock)
(It is at X -2 mm, Y -2 mm, Z 0 mm of the drawing, whose Z 0 is the)
(top of stock)
(T2 flat 3 mm, 18000 rpm)
(Contour T2: depth 2 mm, stepdown 2 mm, stock to leave 0 mm, climb)
(Path within 0.0012 mm of the exact offset of the drawing)
(Exact path: the control does not blend)
(hitofude: program=1)
(hitofude: part=plate)
(hitofude: drawing_units=mm)
(hitofude: join_tolerance_mm=0.01)
(hitofude: units=mm)
(hitofude: origin_mm=-2,-2,0)
(hitofude: stock_mm=-2,-2,-8,42,32,0)
(hitofude: tool=2,flat,3)
(hitofude: operation=contour,tool=2,depth=2,stock_to_leave=0)
(hitofude: path_tolerance_mm=0.0012)
(hitofude: blend_mm=0)
G17 G21 G90 G94 G40 G49 G80
G91.1
G54
G61
(T2 flat 3 mm)
S18000 M3
G4 P2
(Contour T2: depth 2 mm, stepdown 2 mm, stock to leave 0 mm, climb)
G0 Z5.0000
X10.0000 Y7.0000
Z1.0000
G1 Z-1.0000 F200
X34.0000 F450
G3 X37.0000 Y10.0000 I0.0000 J3.0000
G1 Y24.0000
G2 X27.0000 Y24.0000 I-5.0000 J0.0000
X37.0000 Y24.0000 I5.0000 J0.0000
G3 X27.0000 Y24.0000 Z-2.0000 I-5.0000 J0.0000
G0 Z5.0000
M5
M30
