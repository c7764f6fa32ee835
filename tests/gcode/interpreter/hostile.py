"""Texts made to hang, exhaust or crash a reader."""

import random
from collections.abc import Callable

MEGA = 1_000_000
Text = Callable[[], bytes]


def _noise(size: int) -> bytes:
    return random.Random(7).randbytes(size)


def _words(size: int) -> bytes:
    letters = b"GMXYZIJKRFNOPQLSTH#[]=*/+-.0123456789 ()<>;%\n"
    chosen = random.Random(8)
    return bytes(chosen.choice(letters) for _ in range(size))


HOSTILE: dict[str, Text] = {
    "nothing": lambda: b"",
    "line ends only": lambda: b"\n\r\n\r" * MEGA,
    "blanks only": lambda: b" " * (10 * MEGA),
    "brackets in brackets": lambda: b"G0 X" + b"[" * MEGA + b"1" + b"]" * MEGA + b"\n",
    "brackets, many lines": lambda: (b"G0 X" + b"[" * 100 + b"1" + b"]" * 100 + b"\n") * 100,
    "brackets that stay within": lambda: (b"G0 X" + b"[" * 30 + b"1" + b"]" * 30 + b"\n") * 2000,
    "signs": lambda: b"X" + b"-" * 9000 + b"1\n",
    "parameters of parameters": lambda: b"#1=1\nX" + b"#" * 200 + b"1\n",
    "functions in functions": lambda: b"X" + b"sin[" * 2000 + b"1" + b"]" * 2000 + b"\n",
    "a long sum": lambda: b"X[" + b"1+" * 4000 + b"1]\n",
    "a long sum of parameters": lambda: b"#1=1\nX[" + b"#1+" * 3000 + b"1]\n",
    "a tower of powers": lambda: b"G0 X[9**9**9**9]\nX[[[9**9]**9]**9]\n",
    "a tower that fits": lambda: b"#1=2\n" + b"#1=[#1**2]\n" * 100,
    "powers of negatives": lambda: b"G0 X[[-8]**[1/3]]\n",
    "zero to the power minus one": lambda: b"G0 X[0**-1]\n",
    "division by zero": lambda: b"G0 X[1/0]\n",
    "modulo zero": lambda: b"G0 X[1 mod 0]\n",
    "root of a negative": lambda: b"G0 X[sqrt[-1]]\n",
    "logarithm of zero": lambda: b"G0 X[ln[0]]\n",
    "angle of zeros": lambda: b"G0 X[atan[0]/[0]]\n",
    "sine of two": lambda: b"G0 X[asin[2]]\n",
    "exponent of a million": lambda: b"G0 X[exp[1000000]]\n",
    "tangent of a right angle": lambda: b"G0 X[tan[90]]\n",
    "rounding of the huge": lambda: (
        b"#1=[999999999999999*999999999999999]\nG0 X[round[#1*#1*#1]] Y[fix[#1]] Z[fup[#1]]\nG4 P[#1]\nT[#1] M6\n"
    ),
    "number of many digits": lambda: b"G1 F1 X" + b"9" * 9000 + b"\nY0." + b"0" * 9000 + b"1\n",
    "numbers that are none": lambda: b"G0 Xnan Yinf\nX1e999\nX0x10\nX1_000\n",
    "exponents": lambda: b"G0 X1e999\n",
    "far away": lambda: b"G91 F99 G1 X99999999999999\n" * 100,
    "feed of nothing": lambda: b"G1 X1 F0\nX2\n",
    "feed beyond all": lambda: b"G1 F999999999999999 X1\nG93 F999999999999999 X2\n",
    "turns without end": lambda: b"F100 G0 X0 Y0\nG2 X0 Y0 I1 P1000000000\n",
    "turns that are no number": lambda: b"F100 G2 I1 P[1/3]\nG2 I1 P-1\nG2 I1 P0\n",
    "repeats without end": lambda: b"G91 F100 G81 X1 Z-1 R1 L9999999\n" * 20,
    "pecks without end": lambda: b"F100 G83 X1 Z-1000000 R1 Q0.0000001\n",
    "pecks of nothing": lambda: b"F100 G83 X1 Z-1 R1 Q0\n",
    "a dwell without end": lambda: b"G4 P999999999999999\n",
    "a loop without end": lambda: b"o1 while [1]\nG0 X1\no1 endwhile\n",
    "an empty loop without end": lambda: b"o1 while [1]\no1 endwhile\n",
    "a do loop without end": lambda: b"o1 do\n#1=[#1+1]\no1 while [1]\n",
    "a loop of plain blocks": lambda: b"o1 while [1]\n" + b"G1 F1 X1\nX2\n" * 100 + b"o1 endwhile\n",
    "repeats of repeats": lambda: (
        b"".join(b"o%d repeat [1000]\n" % k for k in range(1, 9))
        + b"G0 X1\n"
        + b"".join(b"o%d endrepeat\n" % k for k in range(8, 0, -1))
    ),
    "a huge repeat": lambda: b"o1 repeat [999999999999]\nG91 G0 X1\no1 endrepeat\n",
    "a repeat of no number": lambda: b"o1 repeat [0/0]\no1 endrepeat\no1 repeat [-1]\nG0 X1\no1 endrepeat\n",
    "a subroutine that calls itself": lambda: b"o1 sub\no1 call\no1 endsub\no1 call\n",
    "two that call each other twice": lambda: (
        b"o1 sub\no2 call\no2 call\no1 endsub\no2 sub\no1 call\no1 call\no2 endsub\no1 call\n"
    ),
    "a tree of calls": lambda: (
        b"".join(b"o%d sub\no%d call\no%d call\no%d endsub\n" % (k, k + 1, k + 1, k) for k in range(1, 9))
        + b"o9 sub\nG91 G0 X1\no9 endsub\n"
        + b"o1 call\n" * 2000
    ),
    "subroutines by the million": lambda: (
        b"".join(b"o%d sub\no%d endsub\n" % (k, k) for k in range(MEGA)) + b"o5 call\n"
    ),
    "subroutine in a loop": lambda: (
        b"#1=0\no1 while [#1 lt 99]\no2 sub\nG0 X1\no2 endsub\no2 call\n#1=[#1+1]\no1 endwhile\n"
    ),
    "flow that does not close": lambda: b"o1 while [1]\no2 if [1]\no3 sub\n",
    "flow that never opened": lambda: b"o1 endwhile\no2 endif\no3 endsub\no4 else\no5 break\n",
    "ifs in ifs": lambda: (
        b"".join(b"o%d if [1]\n" % k for k in range(5000))
        + b"G0 X1\n"
        + b"".join(b"o%d endif\n" % k for k in range(4999, -1, -1))
    ),
    "an if with many ways": lambda: b"o1 if [0]\n" + b"o1 elseif [0]\n" * 20000 + b"o1 endif\n",
    "o words of words": lambda: b"o[1/0] call\n",
    "an o word that is computed": lambda: b"#1=3\no#1 call\no[#1+1] call\n",
    "an unknown subroutine": lambda: b"o<no> call\n",
    "a long name": lambda: b"o<" + b"a" * 9000 + b"> call\n",
    "a long number": lambda: b"o99999999999999999999 call\n",
    "a call of 1000 arguments": lambda: b"o1 sub\no1 endsub\no1 call" + b" [1]" * 1000 + b"\n",
    "parameters by the million": lambda: b"".join(b"#<p%d>=1\n" % k for k in range(MEGA // 4)),
    "numbered parameters by the million": lambda: b"".join(b"#%d=1\n" % k for k in range(MEGA // 4)),
    "parameters of one line": lambda: b" ".join(b"#%d=1" % k for k in range(1, 900)) + b"\n",
    "parameters out of range": lambda: b"#-1=2\n#0=1\n#99999999999=1\n#[1/2]=1\nX#1.5\n",
    "a jump to itself": lambda: b"N1 GOTO 1\n",
    "two jumps": lambda: b"N1 GOTO 2\nN2 GOTO 1\n",
    "a jump into the void": lambda: b"GOTO 999999999999\n",
    "conditions of fanuc": lambda: b"#1=0\nN1 #1=#1+1\nIF [#1 LT 999999999] GOTO 1\nG0 X1\n",
    "while of fanuc": lambda: b"WHILE [1 EQ 1] DO 1\nG0 X1\nEND 1\n",
    "whiles of fanuc": lambda: b"WHILE [1 EQ 1] DO 1\n" * 1000,
    "a program that calls itself": lambda: b"O1\nM98 P1\nM99\n",
    "a program that begins again": lambda: b"O1\nG0 X1\nM99\n",
    "repeated calls": lambda: b"O1\nM98 P2 L999999999\nM30\nO2\nG91 G0 X1\nM98 P3 L99999999\nM99\nO3\nG0 X1\nM99\n",
    "calls of what is not there": lambda: b"M98 P77\nM98\nM98 P-1\nM98 P[1/3]\nG65 P1\n",
    "a line of a hundred megabytes": lambda: b"G1" + b" X1" * 33 * MEGA,
    "a comment of a hundred megabytes": lambda: b"(" + b"a" * 100 * MEGA,
    "comments in comments": lambda: b"(" * 9000 + b"\n",
    "many comments": lambda: b"()" * 4000 + b"G0 X1\n" + b"(" * 4999 + b")\n",
    "unclosed": lambda: b"G0 X1 (no end\nG0 X[1\nG0 X#<a\n",
    "zero bytes": lambda: b"\x00" * MEGA + b"G0\x00 X\x001\x00\n",
    "noise": lambda: _noise(MEGA),
    "noise in lines": lambda: _noise(20000).replace(b" ", b"\n"),
    "word salad": lambda: _words(100_000),
    "utf-16": lambda: "G0 X1\nG1 F100 Y2\n".encode("utf-16"),
    "utf-16 cut": lambda: b"\xff\xfeG",
    "utf-8 that is none": lambda: b"(\xc3\x41 \xff)\nG0 X1\n\xff\xfe\n",
    "marks": lambda: b"\xef\xbb\xbf\xef\xbb\xbfG0 X1\n",
    "digits of other scripts": lambda: "G0 X\uff11\uff12 Y\u0663\nG\uff11 X\u00b2\nX\u2167\n".encode(),
    "cases that change length": lambda: "İßﬁ G0 X1\n(İ) G0 X1 Q\nİ\n".encode(),
    "per cent": lambda: b"%\n" * MEGA,
    "slashes": lambda: b"/" * 9000 + b"G0 X1\n",
    "axes of nothing": lambda: b"X\nX Y Z\n",
    "many words": lambda: b"G0 " + b"X1 " * 3000,
    "dots": lambda: b"X.\nX..\nX-.\nX1.2.3\n",
    "splines without end": lambda: b"F1 G5.2 P1 L3 X0 Y0\n" + b"X1 Y1 P1\n" * 20_000 + b"G5.3\n",
    "splines of nothing": lambda: b"F1 G5.2 P0 L0\nG5.3\nG5.2 P-1 L99999999\nX1 P1\nG5.3\nG5\nG5.1 X1\n",
    "curves": lambda: b"F1\n" + b"G5 I0 J1 P0 Q-1 X1 Y1\n" * 5000,
    "tools of any number": lambda: b"T999999999999 M6\nT-1 M6\nT1.5 M6\nT[1/3] M6\nG43 H-1\nG43 H99999\n",
    "codes": lambda: b"G999\nM999\nG-1\nG1.23\nG[1+1]\nM[1/0]\n",
    "offsets": lambda: b"G10 L2 P99\nG10 L99\nG10 L2 P1 R999999999 X99999999\nG54.1 P9999\nG92 X999999999999\nG52\n",
    "events": lambda: b"G4 P1\n" * 60_000,
}
"""Makers of texts by what they do."""
