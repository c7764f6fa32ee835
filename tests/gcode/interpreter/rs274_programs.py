"""Programs for every feature of the reader, that LinuxCNC's interpreter takes; all end by themselves."""

PROGRAMS: dict[str, str] = {
    "units": "G20 G0 X1 Y.5\nG21 G1 F300 X-3.5 Y0\nG20 F10 X0\nM2\n",
    "modal words": "G0 X1\nY2\nG1 F100 Z-1\nX5 Y5\nF200\nX6\nG0 Z5\nM2\n",
    "motion word alone": "G1 F100\nG0\nX1\nM2\n",
    "lower case and blanks": "g0x1y2\n g 1 f 1 0 0 x - 1 . 5 y + 2 . \nx.5y-.25 (hi) z3 ; end\n\nm2\n",
    "incremental": "G91 G0 X1 Y1\nG1 F50 X.1\nX.1 Z-2\nG90 X0\nG91 G2 X2 I1 J0\nM2\n",
    "arcs xy": "G0 X0 Y0\nF100 G2 X1 Y1 I1 J0\nG3 X0 Y0 I-.5 J-.5\nG3 X0 Y0 I1\nG2 I-1 J2\nI3\nG2 X2 Y0 I1\nX4 I1 "
    "Z-3\nM2\n",
    "arcs zx": "G18 G0 X0 Z0\nF100 G2 X1 Z1 I1 K0\nG3 X0 Z0 I-.5 K-.5\nG3 X2 I1 Y5\nG2 K2\nG2 X3 Z1 R4\nM2\n",
    "arcs yz": "G19 G0 Y0 Z0\nF100 G2 Y1 Z1 J1 K0\nG3 Y0 Z0 J-.5 K-.5\nG3 Y2 J1 X5\nG3 K2\nG3 Y3 Z1 R-4\nM2\n",
    "radius arcs": "F100 G0 X0 Y0\nG2 X1 Y1 R1\nG3 X2 Y2 R1\nG2 X3 Y3 R-1\nG3 X4 Y4 R-1.5\nG2 X6 R.9995\nG3 X5 Y5 Z2 "
    "R10\nM2\n",
    "radius arcs in inch": "G20 F10 G0 X0 Y0\nG2 X1 Y1 R1\nG3 X2 Y2 R1.25\nG2 X3 R.49996\nM2\n",
    "absolute centres": "F100 G0 X10 Y10\nG90.1 G2 X20 Y10 I15 J10\nG3 X10 Y10 I15 J10\nG18 G2 X11 Z1 I11 K0\nG91.1 "
    "G17 G2 X13 I1\nM2\n",
    "absolute centres and offset": "G10 L2 P1 X5 Y7\nF100 G0 X10 Y10\nG90.1 G2 X20 Y10 I15 J10\nG3 X10 Y10 I15 "
    "J10\nM2\n",
    "helix with turns": "F100 G0 X0 Y0 Z0\nG2 X0 Y0 Z-5 I5 P5\nG3 X10 Z0 I5 P2\nG2 X0 R5 P3\nM2\n",
    "work offsets": "G10 L2 P1 X1 Y2 Z3\nG10 L2 P2 X-1\nG54 G0 X0 Y0 Z0\nG55 X0\nY1\nG59.3 G0 X1\nG10 L2 P9 "
    "X3\nX1\nG54 X0\nM2\n",
    "offset under the tool": "G0 X1 Y1\nG10 L20 P1 X0 Y5\nX2\nG10 L20 P3 X3\nG56 X0 Y0\nM2\n",
    "g52": "G0 X1\nG52 X10 Y5\nX1 Y1\nG52 X0 Y0\nX1 Y1\nM2\n",
    "g92": "G0 X1 Y2\nG92 X0 Y0\nX1\nG92.2\nX1\nG92.3\nX1\nG92 Z5\nZ6\nG92.1\nX0 Y0 Z0\nM2\n",
    "offsets together": "G10 L2 P2 X10 Y20 Z30\nG55 G0 X1 Y1 Z1\nG92 X5\nX6 Y2\nG43 H2\nZ0\nG52 Y3\nG0 X0 Y0 "
    "Z0\nG49\nZ1\nG92.1\nX0\nM2\n",
    "rotation": "G10 L2 P1 X5 Y5 R30\nF100 G0 X1 Y1\nG1 X2\nG2 X4 I1 J0\nG91 X2 I1\nG90 G3 X0 Y0 R20\nG10 L2 P1 R0\nX1 "
    "R20\nM2\n",
    "tool length": "T1 M6 G43\nG0 X1 Z5\nT2 M6\nG43 H2\nG0 Z5\nX2\nG49\nZ5\nG43.1 Z3\nZ1\nX1\nG43.2 H1\nX3\nZ3\nM2\n",
    "home": "G0 X1 Y2 Z3\nG28.1\nX5\nG28 X0\nG0 X7 Y7 Z7\nG30.1\nG0 X0 Y0 Z0\nG30\nG28 Z9\nG28\nM2\n",
    "home with offsets": "G10 L2 P1 X1 Y1 Z1\nT2 M6 G43 H2\nG0 X1 Y2 Z3\nG28.1\nX5\nG28 X0 Z4\nG28\nG91 G28 "
    "Z1\nX1\nM2\n",
    "machine coordinates": "G10 L2 P1 X10 Y10\nG0 X1\nG53 G0 X1\nG53 G1 F50 X3 Y3\nX0\nG92 X5\nG53 X0\nM2\n",
    "dwell and path": "G64 P.01 Q.02\nG0 X1\nG4 P.5\nG61\nG1 F100 X2\nG61.1\nX3\nG64\nX4\nM2\n",
    "spindle and coolant": "S1000 M3\nG0 X1\nM7\nM8\nG1 F100 X2\nM9\nG96 D2000 S50 M3\nX3\nG97 S500\nX4 "
    "M5\nM0\nM1\nM30\n",
    "inverse time": "G93 G1 X5 F2\nX6 F3\nG94 F100 X7\nG95 S500 M3 F.1\nX8\nM2\n",
    "n words": "N10 G0 X1\nn0020 x2\nN999999 X3\nM2\n",
    "block delete": "G0 X1\n/X2\n/ G1 F100 X3\nX4\nM2\n",
    "percent": "%\nG0 X1\nG1 F100 Y1\n%\nX9\n",
    "expressions": "#1=2.5 #2=[#1*2]\nG0 X#1 Y[#2-1]\nX[sin[30]] Y[atan[1]/[1]] Z[2**3]\nX[10 mod 3] Y[fix[-1.5]] "
    "Z[fup[1.2]]\n"
    "X[round[2.5]] Y[abs[-3]] Z[sqrt[9]]\nX-#1 Y[-#1] Z[1+2*3-4/2]\nX[ln[exp[1]]] Y[acos[0]] "
    "Z[asin[1]]\n#3=1\nX##3\nM2\n",
    "comparisons": "G0 X[1 lt 2] Y[2 le 1] Z[1 eq 1]\nX[1 ne 1] Y[3 gt 2] Z[2 ge 3]\nX[1 and 0] Y[1 or 0] Z[1 xor "
    "1]\nM2\n",
    "named parameters": "#<width>=10 #<_global>=3\nG0 X#<width> Y#<_global>\n#<width>=[#<width>+1]\n"
    "X#<width> Z[exists[#<width>]] Y[exists[#<no>]]\nM2\n",
    "parameters change after the line": "#1=1\n#1=2 G0 X#1\nX#1\n#1=[#1+1] #2=#1 X#2\nX#2\nM2\n",
    "subroutine": "o100 sub\nG0 X#1 Y#2\n#1=99\no100 endsub\n#1=5\no100 call [1] [2]\no100 call [3] [4]\nX#1\nM2\n",
    "named subroutine": "o<hole> sub\n#<d>=#1\nG1 F100 X#<d>\no<hole> return [#1*2]\no<hole> endsub\no<hole> call "
    "[4]\nG0 X#<_value>\nM2\n",
    "while": "#1=0\no1 while [#1 lt 5]\nG1 F100 X#1\n#1=[#1+1]\no1 endwhile\nG0 Z1\nM2\n",
    "do while": "#1=0\no1 do\nG1 F100 X#1\n#1=[#1+1]\no1 while [#1 lt 3]\nM2\n",
    "repeat": "G91\no7 repeat [3]\nG1 F100 X1\no7 endrepeat\nG90 G0 X0\nM2\n",
    "if": "#1=3\no1 if [#1 gt 5]\nG0 X1\no1 elseif [#1 gt 2]\nG0 X2\no1 else\nG0 X3\no1 endif\nG0 Y1\nM2\n",
    "break and continue": "#1=0\no1 while [1]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 endif\no3 if [#1 gt 4]\no1 "
    "break\no3 endif\n"
    "G0 X#1\no1 endwhile\nM2\n",
    "nested calls": "o1 sub\no2 call [#1+1]\nG0 X#1\no1 endsub\no2 sub\nG0 Y#1\no2 endsub\no1 call [5]\nM2\n",
    "drilling": "G0 X0 Y0 Z5\nG98 G81 X1 Y1 Z-2 R1 F100\nX2\nG99 X3 Y2\nX4 Z-3\nG80\nG0 Z5\n"
    "G82 X5 P.5 Z-1 R2\nG91 G81 X1 Z-.6 R-1 L3\nG90 G80\nM2\n",
    "drilling under G92": "F100 G0 X1 Z12.65\nG92 Z-19.47\nG0 Z50\nG99 G81 X0 Y0 Z0 R45\nX1\nG80\nM2\n",
    "pecks": "G0 X0 Y0 Z5\nG83 X1 Z-4 R1 Q1.5 F100\nG73 X2 Z-4 R1 Q1.5\nG80\nG18 G83 X0 Y-4 Z0 R1 Q1\nG80\nM2\n",
    "boring": "S500 M3 G0 X0 Y0 Z5\nG85 X1 Z-1 R1 F100\nG86 X2 Z-1 R1 P.1\nG89 X3 Z-1 R1 P.5\nG80\nM2\n",
    "cycles in inch": "G20 G0 X0 Y0 Z1\nG81 X1 Y1 Z-.25 R.1 F10\nX2 L2\nG80\nM2\n",
    "cycles in yz": "G19 G0 X5 Y0 Z0\nG81 X-2 Y1 Z1 R1 F100\nY2\nG80\nM2\n",
    "splines": "F100 G0 X0 Y0\nG5 I0 J3 P0 Q-3 X1 Y1\nG5 P0 Q-3 X2 Y2\nG5.1 X4 Y0 I1 J1\nG0 X0 Y0\n"
    "G5.2 P1 L3 X0 Y1\nX2 Y2 P1\nX2 Y0 P1\nX0 Y0 P2\nG5.3\nM2\n",
    "threads": "F100 G0 X0 Z0\nG1 Z-1\nS100 M3\nG33 Z-5 K1\nM2\n",
    "end in the middle": "G0 X1\nM2\nG0 X2\n",
    "unfinished words before": "M3 S100 F50\nT1\nM6\nG43\nG1 X1 Z1\nM30\n",
}
"""Texts by what they are about."""
