(Part plate)
(Hitofude for grbl, lengths in mm)
(File 1 of 2, with T1 alone, X and Y zero as in the others)
(Set Z zero with this tool in the spindle)
(Stock 44 mm x 34 mm x 8 mm)
(Work origin: lower left of stock, top of stock)
(It is at X -2 mm, Y -2 mm, Z 0 mm of the drawing, whose Z 0 is the)
(top of stock)
(T1 flat 6 mm, 12000 rpm)
(Pocket T1: depth 2 mm, stepdown 2 mm, stock to leave 0 mm, climb,)
(stepover automatic)
(Path within 0.0012 mm of the exact offset of the drawing)
(Exact path: the control does not blend)
(hitofude: program=1)
(hitofude: part=plate)
(hitofude: drawing_units=mm)
(hitofude: join_tolerance_mm=0.01)
(hitofude: units=mm)
(hitofude: origin_mm=-2,-2,0)
(hitofude: stock_mm=-2,-2,-8,42,32,0)
(hitofude: tool=1,flat,6)
(hitofude: operation=pocket,tool=1,depth=2,stock_to_leave=0)
(hitofude: path_tolerance_mm=0.0012)
(hitofude: blend_mm=0)
G17 G21 G90 G94 G40 G49 G80
G91.1
G54
G61
(T1 flat 6 mm)
S12000 M3
G4 P2
(Pocket T1: depth 2 mm, stepdown 2 mm, stock to leave 0 mm, climb,)
(stepover automatic)
G0 Z5.0000
X12.0000 Y12.0000
Z1.0000
G1 Z-1.0000 F200
X32.0000 F600
Y22.0000
X12.0000
Y12.0000
G0 Z5.0000
M5
M30
