(Part plate)
(Hitofude for grbl, lengths in inch)
(File 1 of 2, with T1 alone, X and Y zero as in the others)
(Set Z zero with this tool in the spindle)
(Stock 1.732283 in x 1.338583 in x 0.314961 in)
(Work origin: lower left of stock, top of stock)
(It is at X -0.07874 in, Y -0.07874 in, Z 0 in of the drawing,)
(whose Z 0 is the top of stock)
(T1 flat 0.23622 in, 12000 rpm)
(Pocket T1: depth 0.07874 in, stepdown 0.07874 in, stock to leave 0)
(in, climb, stepover automatic)
(Path within 0.000059 in of the exact offset of the drawing)
(Exact path: the control does not blend)
(hitofude: program=1)
(hitofude: part=plate)
(hitofude: drawing_units=mm)
(hitofude: join_tolerance_mm=0.01)
(hitofude: units=in)
(hitofude: origin_mm=-2,-2,0)
(hitofude: stock_mm=-2,-2,-8,42,32,0)
(hitofude: tool=1,flat,6)
(hitofude: operation=pocket,tool=1,depth=2,stock_to_leave=0)
(hitofude: path_tolerance_mm=0.001508)
(hitofude: blend_mm=0)
G17 G20 G90 G94 G40 G49 G80
G91.1
G54
G61
(T1 flat 0.23622 in)
S12000 M3
G4 P2
(Pocket T1: depth 0.07874 in, stepdown 0.07874 in, stock to leave 0)
(in, climb, stepover automatic)
G0 Z0.19685
X0.47244 Y0.47244
Z0.03937
G1 Z-0.03937 F7.87
X1.25984 F23.62
Y0.86614
X0.47244
Y0.47244
G0 Z0.19685
M5
M30
