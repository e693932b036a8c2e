#include "colors.inc"
#include "finish.inc"

global_settings {assumed_gamma 1 max_trace_level 6}
background {color White}
camera {perspective
  right -17.04*x up 15.45*y
  direction 60.00*z
  location <0,0,60.00> look_at <0,0,0>}


light_source {< 20.00,  30.00,  40.00> color White
  area_light <8.00, 0, 0>, <0, 8.00, 0>, 7, 7
  adaptive 1 jitter}
// no fog
#declare simple = finish {phong 0.7}
#declare pale = finish {ambient 0.5 diffuse 0.85 roughness 0.001 specular 0.200 }
#declare intermediate = finish {ambient 0.3 diffuse 0.6 specular 0.1 roughness 0.04}
#declare vmd = finish {ambient 0.0 diffuse 0.65 phong 0.1 phong_size 40.0 specular 0.5 }
#declare jmol = finish {ambient 0.2 diffuse 0.6 specular 1 roughness 0.001 metallic}
#declare ase2 = finish {ambient 0.05 brilliance 3 diffuse 0.6 metallic specular 0.7 roughness 0.04 reflection 0.15}
#declare ase3 = finish {ambient 0.15 brilliance 2 diffuse 0.6 metallic specular 1.0 roughness 0.001 reflection 0.0}
#declare glass = finish {ambient 0.05 diffuse 0.3 specular 1.0 roughness 0.001}
#declare glass2 = finish {ambient 0.01 diffuse 0.3 specular 1.0 reflection 0.25 roughness 0.001}
#declare Rcell = 0.050;
#declare Rbond = 0.170;

#macro atom(LOC, R, COL, TRANS, FIN)
  sphere{LOC, R texture{pigment{color COL transmit TRANS} finish{FIN}}}
#end
#macro constrain(LOC, R, COL, TRANS FIN)
union{torus{R, Rcell rotate 45*z texture{pigment{color COL transmit TRANS} finish{FIN}}}
     torus{R, Rcell rotate -45*z texture{pigment{color COL transmit TRANS} finish{FIN}}}
     translate LOC}
#end

// no cell vertices
atom(< -2.30,  -3.84,  -7.41>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #0
atom(< -3.92,  -6.74,  -7.53>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #1
atom(< -2.33,  -6.40,  -6.51>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #2
atom(< -3.15,  -5.84,  -9.04>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #3
atom(< -4.66,  -5.08,  -6.92>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #4
atom(< -3.78,  -0.51,  -6.19>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #5
atom(< -5.41,  -3.41,  -6.31>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #6
atom(< -3.81,  -3.08,  -5.29>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #7
atom(< -4.63,  -2.51,  -7.82>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #8
atom(< -6.15,  -1.75,  -5.70>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #9
atom(< -5.27,   2.81,  -4.97>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #10
atom(< -6.89,  -0.09,  -5.09>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #11
atom(< -5.30,   0.25,  -4.07>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #12
atom(< -6.12,   0.81,  -6.60>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #13
atom(< -7.64,   1.57,  -4.48>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #14
atom(< -0.75,  -2.04, -10.43>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #15
atom(< -2.37,  -4.94, -10.55>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #16
atom(< -0.78,  -4.60,  -9.53>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #17
atom(< -1.60,  -4.04, -12.06>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #18
atom(< -3.12,  -3.28,  -9.94>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #19
atom(< -2.24,   1.29,  -9.21>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #20
atom(< -3.86,  -1.62,  -9.33>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #21
atom(< -2.27,  -1.28,  -8.31>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #22
atom(< -3.09,  -0.72, -10.84>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #23
atom(< -4.60,   0.05,  -8.72>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #24
atom(< -3.72,   4.61,  -7.99>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #25
atom(< -5.35,   1.71,  -8.11>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #26
atom(< -3.75,   2.05,  -7.09>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #27
atom(< -4.57,   2.61,  -9.62>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #28
atom(< -6.09,   3.37,  -7.50>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #29
atom(<  0.79,  -0.24, -13.45>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #30
atom(< -0.83,  -3.14, -13.57>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #31
atom(<  0.76,  -2.80, -12.55>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #32
atom(< -0.05,  -2.24, -15.08>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #33
atom(< -1.57,  -1.48, -12.96>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #34
atom(< -0.69,   3.08, -12.23>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #35
atom(< -2.31,   0.18, -12.35>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #36
atom(< -0.72,   0.52, -11.33>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #37
atom(< -1.54,   1.08, -13.86>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #38
atom(< -3.06,   1.85, -11.74>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #39
atom(< -2.18,   6.41, -11.01>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #40
atom(< -3.80,   3.51, -11.13>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #41
atom(< -2.21,   3.85, -10.11>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #42
atom(< -3.03,   4.41, -12.64>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #43
atom(< -4.54,   5.17, -10.52>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #44
atom(<  0.89,  -3.16,  -5.37>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #45
atom(< -0.74,  -6.06,  -5.49>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #46
atom(<  0.86,  -5.72,  -4.47>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #47
atom(<  0.04,  -5.16,  -7.00>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #48
atom(< -1.48,  -4.40,  -4.88>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #49
atom(< -0.60,   0.16,  -4.15>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #50
atom(< -2.22,  -2.74,  -4.27>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #51
atom(< -0.63,  -2.40,  -3.25>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #52
atom(< -1.45,  -1.84,  -5.78>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #53
atom(< -2.96,  -1.08,  -3.66>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #54
atom(< -2.08,   3.49,  -2.93>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #55
atom(< -3.71,   0.59,  -3.05>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #56
atom(< -2.11,   0.93,  -2.03>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #57
atom(< -2.93,   1.49,  -4.56>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #58
atom(< -4.45,   2.25,  -2.44>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #59
atom(<  2.43,  -1.36,  -8.39>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #60
atom(<  0.81,  -4.26,  -8.51>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #61
atom(<  2.40,  -3.92,  -7.49>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #62
atom(<  1.58,  -3.36, -10.02>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #63
atom(<  0.07,  -2.60,  -7.90>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #64
atom(<  0.95,   1.96,  -7.17>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #65
atom(< -0.68,  -0.94,  -7.29>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #66
atom(<  0.92,  -0.60,  -6.27>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #67
atom(<  0.10,  -0.04,  -8.80>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #68
atom(< -1.42,   0.72,  -6.68>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #69
atom(< -0.54,   5.29,  -5.95>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #70
atom(< -2.16,   2.39,  -6.07>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #71
atom(< -0.57,   2.72,  -5.05>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #72
atom(< -1.39,   3.29,  -7.58>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #73
atom(< -2.90,   4.05,  -5.46>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #74
atom(<  3.98,   0.44, -11.41>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #75
atom(<  2.36,  -2.46, -11.53>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #76
atom(<  3.95,  -2.12, -10.51>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #77
atom(<  3.13,  -1.56, -13.04>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #78
atom(<  1.61,  -0.80, -10.92>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #79
atom(<  2.49,   3.76, -10.19>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #80
atom(<  0.87,   0.86, -10.31>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #81
atom(<  2.46,   1.20,  -9.29>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #82
atom(<  1.64,   1.76, -11.82>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #83
atom(<  0.13,   2.52,  -9.70>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #84
atom(< -0.61,   4.19,  -9.09>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #85
atom(<  0.98,   4.52,  -8.07>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #86
atom(<  0.16,   5.09, -10.60>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #87
atom(< -1.36,   5.85,  -8.48>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #88
atom(<  4.07,  -2.48,  -3.34>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #89
atom(<  2.45,  -5.38,  -3.46>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #90
atom(<  4.04,  -5.05,  -2.44>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #91
atom(<  3.22,  -4.48,  -4.97>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #92
atom(<  1.71,  -3.72,  -2.85>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #93
atom(<  2.59,   0.84,  -2.12>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #94
atom(<  0.96,  -2.06,  -2.24>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #95
atom(<  2.56,  -1.72,  -1.22>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #96
atom(<  1.74,  -1.16,  -3.75>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #97
atom(<  0.22,  -0.40,  -1.63>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #98
atom(<  1.10,   4.16,  -0.90>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #99
atom(< -0.52,   1.26,  -1.02>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #100
atom(<  1.07,   1.60,   0.00>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #101
atom(<  0.25,   2.16,  -2.53>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #102
atom(< -1.26,   2.93,  -0.41>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #103
atom(<  5.62,  -0.68,  -6.36>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #104
atom(<  4.00,  -3.59,  -6.48>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #105
atom(<  5.59,  -3.25,  -5.46>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #106
atom(<  4.77,  -2.69,  -7.99>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #107
atom(<  3.25,  -1.92,  -5.87>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #108
atom(<  4.13,   2.64,  -5.14>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #109
atom(<  2.51,  -0.26,  -5.26>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #110
atom(<  4.10,   0.08,  -4.24>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #111
atom(<  3.28,   0.64,  -6.77>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #112
atom(<  1.77,   1.40,  -4.65>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #113
atom(<  1.02,   3.06,  -4.04>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #114
atom(<  2.62,   3.40,  -3.02>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #115
atom(<  1.80,   3.96,  -5.55>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #116
atom(<  0.28,   4.73,  -3.43>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #117
atom(<  7.17,   1.11,  -9.38>, 0.95, rgb <0.16, 0.40, 0.62>, 0.0, ase3) // #118
atom(<  5.54,  -1.79,  -9.50>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #119
atom(<  7.14,  -1.45,  -8.48>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #120
atom(<  6.32,  -0.89, -11.01>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #121
atom(<  4.80,  -0.12,  -8.89>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #122
atom(<  4.06,   1.54,  -8.28>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #123
atom(<  5.65,   1.88,  -7.26>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #124
atom(<  4.83,   2.44,  -9.79>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #125
atom(<  3.31,   3.20,  -7.67>, 0.48, rgb <0.80, 0.10, 0.07>, 0.0, ase3) // #126
atom(<  2.57,   4.86,  -7.06>, 0.62, rgb <0.84, 0.84, 0.86>, 0.0, ase3) // #127
cylinder {< -3.92,  -6.74,  -7.53>, < -3.12,  -6.57,  -7.02>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -2.33,  -6.40,  -6.51>, < -3.12,  -6.57,  -7.02>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.92,  -6.74,  -7.53>, < -3.53,  -6.29,  -8.28>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -3.15,  -5.84,  -9.04>, < -3.53,  -6.29,  -8.28>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.92,  -6.74,  -7.53>, < -4.29,  -5.91,  -7.22>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -4.66,  -5.08,  -6.92>, < -4.29,  -5.91,  -7.22>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.33,  -6.40,  -6.51>, < -1.53,  -6.23,  -6.00>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.74,  -6.06,  -5.49>, < -1.53,  -6.23,  -6.00>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -3.15,  -5.84,  -9.04>, < -2.76,  -5.39,  -9.79>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.37,  -4.94, -10.55>, < -2.76,  -5.39,  -9.79>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -4.66,  -5.08,  -6.92>, < -5.04,  -4.25,  -6.61>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -5.41,  -3.41,  -6.31>, < -5.04,  -4.25,  -6.61>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -5.41,  -3.41,  -6.31>, < -4.61,  -3.25,  -5.80>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -3.81,  -3.08,  -5.29>, < -4.61,  -3.25,  -5.80>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -5.41,  -3.41,  -6.31>, < -5.02,  -2.96,  -7.06>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -4.63,  -2.51,  -7.82>, < -5.02,  -2.96,  -7.06>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -5.41,  -3.41,  -6.31>, < -5.78,  -2.58,  -6.00>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -6.15,  -1.75,  -5.70>, < -5.78,  -2.58,  -6.00>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.81,  -3.08,  -5.29>, < -3.02,  -2.91,  -4.78>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.22,  -2.74,  -4.27>, < -3.02,  -2.91,  -4.78>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -4.63,  -2.51,  -7.82>, < -4.25,  -2.06,  -8.57>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.86,  -1.62,  -9.33>, < -4.25,  -2.06,  -8.57>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -6.15,  -1.75,  -5.70>, < -6.52,  -0.92,  -5.39>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -6.89,  -0.09,  -5.09>, < -6.52,  -0.92,  -5.39>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -6.89,  -0.09,  -5.09>, < -6.10,   0.08,  -4.58>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -5.30,   0.25,  -4.07>, < -6.10,   0.08,  -4.58>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -6.89,  -0.09,  -5.09>, < -6.51,   0.36,  -5.84>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -6.12,   0.81,  -6.60>, < -6.51,   0.36,  -5.84>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -6.89,  -0.09,  -5.09>, < -7.26,   0.74,  -4.78>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -7.64,   1.57,  -4.48>, < -7.26,   0.74,  -4.78>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -5.30,   0.25,  -4.07>, < -4.50,   0.42,  -3.56>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.71,   0.59,  -3.05>, < -4.50,   0.42,  -3.56>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -6.12,   0.81,  -6.60>, < -5.73,   1.26,  -7.35>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -5.35,   1.71,  -8.11>, < -5.73,   1.26,  -7.35>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -2.37,  -4.94, -10.55>, < -1.99,  -4.49, -11.30>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -1.60,  -4.04, -12.06>, < -1.99,  -4.49, -11.30>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.37,  -4.94, -10.55>, < -2.75,  -4.11, -10.24>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -3.12,  -3.28,  -9.94>, < -2.75,  -4.11, -10.24>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.37,  -4.94, -10.55>, < -1.58,  -4.77, -10.04>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -0.78,  -4.60,  -9.53>, < -1.58,  -4.77, -10.04>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.78,  -4.60,  -9.53>, <  0.01,  -4.43,  -9.02>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.81,  -4.26,  -8.51>, <  0.01,  -4.43,  -9.02>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -1.60,  -4.04, -12.06>, < -1.21,  -3.59, -12.81>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.83,  -3.14, -13.57>, < -1.21,  -3.59, -12.81>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -3.12,  -3.28,  -9.94>, < -3.49,  -2.45,  -9.63>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.86,  -1.62,  -9.33>, < -3.49,  -2.45,  -9.63>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -3.86,  -1.62,  -9.33>, < -4.23,  -0.78,  -9.02>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -4.60,   0.05,  -8.72>, < -4.23,  -0.78,  -9.02>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.86,  -1.62,  -9.33>, < -3.06,  -1.45,  -8.82>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -2.27,  -1.28,  -8.31>, < -3.06,  -1.45,  -8.82>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.86,  -1.62,  -9.33>, < -3.47,  -1.17, -10.08>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -3.09,  -0.72, -10.84>, < -3.47,  -1.17, -10.08>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.27,  -1.28,  -8.31>, < -1.47,  -1.11,  -7.80>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.68,  -0.94,  -7.29>, < -1.47,  -1.11,  -7.80>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -3.09,  -0.72, -10.84>, < -2.70,  -0.27, -11.59>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.31,   0.18, -12.35>, < -2.70,  -0.27, -11.59>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -4.60,   0.05,  -8.72>, < -4.97,   0.88,  -8.41>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -5.35,   1.71,  -8.11>, < -4.97,   0.88,  -8.41>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -5.35,   1.71,  -8.11>, < -4.96,   2.16,  -8.86>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -4.57,   2.61,  -9.62>, < -4.96,   2.16,  -8.86>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -5.35,   1.71,  -8.11>, < -5.72,   2.54,  -7.80>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -6.09,   3.37,  -7.50>, < -5.72,   2.54,  -7.80>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -5.35,   1.71,  -8.11>, < -4.55,   1.88,  -7.60>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -3.75,   2.05,  -7.09>, < -4.55,   1.88,  -7.60>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.75,   2.05,  -7.09>, < -2.96,   2.22,  -6.58>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.16,   2.39,  -6.07>, < -2.96,   2.22,  -6.58>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -4.57,   2.61,  -9.62>, < -4.19,   3.06, -10.37>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.80,   3.51, -11.13>, < -4.19,   3.06, -10.37>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -0.83,  -3.14, -13.57>, < -0.03,  -2.97, -13.06>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.76,  -2.80, -12.55>, < -0.03,  -2.97, -13.06>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.83,  -3.14, -13.57>, < -0.44,  -2.69, -14.32>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -0.05,  -2.24, -15.08>, < -0.44,  -2.69, -14.32>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.83,  -3.14, -13.57>, < -1.20,  -2.31, -13.26>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -1.57,  -1.48, -12.96>, < -1.20,  -2.31, -13.26>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.76,  -2.80, -12.55>, <  1.56,  -2.63, -12.04>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.36,  -2.46, -11.53>, <  1.56,  -2.63, -12.04>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -1.57,  -1.48, -12.96>, < -1.94,  -0.65, -12.65>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.31,   0.18, -12.35>, < -1.94,  -0.65, -12.65>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -2.31,   0.18, -12.35>, < -2.69,   1.02, -12.04>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -3.06,   1.85, -11.74>, < -2.69,   1.02, -12.04>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.31,   0.18, -12.35>, < -1.52,   0.35, -11.84>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -0.72,   0.52, -11.33>, < -1.52,   0.35, -11.84>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.31,   0.18, -12.35>, < -1.93,   0.63, -13.10>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -1.54,   1.08, -13.86>, < -1.93,   0.63, -13.10>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.72,   0.52, -11.33>, <  0.08,   0.69, -10.82>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.87,   0.86, -10.31>, <  0.08,   0.69, -10.82>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -3.06,   1.85, -11.74>, < -3.43,   2.68, -11.43>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.80,   3.51, -11.13>, < -3.43,   2.68, -11.43>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -3.80,   3.51, -11.13>, < -4.17,   4.34, -10.82>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -4.54,   5.17, -10.52>, < -4.17,   4.34, -10.82>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.80,   3.51, -11.13>, < -3.00,   3.68, -10.62>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -2.21,   3.85, -10.11>, < -3.00,   3.68, -10.62>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.80,   3.51, -11.13>, < -3.41,   3.96, -11.88>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -3.03,   4.41, -12.64>, < -3.41,   3.96, -11.88>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.21,   3.85, -10.11>, < -1.41,   4.02,  -9.60>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.61,   4.19,  -9.09>, < -1.41,   4.02,  -9.60>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -0.74,  -6.06,  -5.49>, < -1.11,  -5.23,  -5.19>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -1.48,  -4.40,  -4.88>, < -1.11,  -5.23,  -5.19>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.74,  -6.06,  -5.49>, < -0.35,  -5.61,  -6.25>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.04,  -5.16,  -7.00>, < -0.35,  -5.61,  -6.25>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.74,  -6.06,  -5.49>, <  0.06,  -5.89,  -4.98>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.86,  -5.72,  -4.47>, <  0.06,  -5.89,  -4.98>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.86,  -5.72,  -4.47>, <  1.65,  -5.55,  -3.97>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.45,  -5.38,  -3.46>, <  1.65,  -5.55,  -3.97>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.04,  -5.16,  -7.00>, <  0.42,  -4.71,  -7.76>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.81,  -4.26,  -8.51>, <  0.42,  -4.71,  -7.76>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -1.48,  -4.40,  -4.88>, < -1.85,  -3.57,  -4.58>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.22,  -2.74,  -4.27>, < -1.85,  -3.57,  -4.58>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -2.22,  -2.74,  -4.27>, < -1.83,  -2.29,  -5.03>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -1.45,  -1.84,  -5.78>, < -1.83,  -2.29,  -5.03>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.22,  -2.74,  -4.27>, < -2.59,  -1.91,  -3.97>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -2.96,  -1.08,  -3.66>, < -2.59,  -1.91,  -3.97>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.22,  -2.74,  -4.27>, < -1.43,  -2.57,  -3.76>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -0.63,  -2.40,  -3.25>, < -1.43,  -2.57,  -3.76>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.63,  -2.40,  -3.25>, <  0.17,  -2.23,  -2.75>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.96,  -2.06,  -2.24>, <  0.17,  -2.23,  -2.75>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -1.45,  -1.84,  -5.78>, < -1.06,  -1.39,  -6.54>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.68,  -0.94,  -7.29>, < -1.06,  -1.39,  -6.54>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -2.96,  -1.08,  -3.66>, < -3.34,  -0.24,  -3.36>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.71,   0.59,  -3.05>, < -3.34,  -0.24,  -3.36>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -3.71,   0.59,  -3.05>, < -3.32,   1.04,  -3.81>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -2.93,   1.49,  -4.56>, < -3.32,   1.04,  -3.81>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.71,   0.59,  -3.05>, < -4.08,   1.42,  -2.75>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -4.45,   2.25,  -2.44>, < -4.08,   1.42,  -2.75>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -3.71,   0.59,  -3.05>, < -2.91,   0.76,  -2.54>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -2.11,   0.93,  -2.03>, < -2.91,   0.76,  -2.54>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.11,   0.93,  -2.03>, < -1.32,   1.09,  -1.53>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.52,   1.26,  -1.02>, < -1.32,   1.09,  -1.53>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -2.93,   1.49,  -4.56>, < -2.55,   1.94,  -5.32>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.16,   2.39,  -6.07>, < -2.55,   1.94,  -5.32>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.81,  -4.26,  -8.51>, <  1.20,  -3.81,  -9.27>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  1.58,  -3.36, -10.02>, <  1.20,  -3.81,  -9.27>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.81,  -4.26,  -8.51>, <  0.44,  -3.43,  -8.21>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.07,  -2.60,  -7.90>, <  0.44,  -3.43,  -8.21>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.81,  -4.26,  -8.51>, <  1.61,  -4.09,  -8.00>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  2.40,  -3.92,  -7.49>, <  1.61,  -4.09,  -8.00>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.40,  -3.92,  -7.49>, <  3.20,  -3.75,  -6.99>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  4.00,  -3.59,  -6.48>, <  3.20,  -3.75,  -6.99>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  1.58,  -3.36, -10.02>, <  1.97,  -2.91, -10.78>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.36,  -2.46, -11.53>, <  1.97,  -2.91, -10.78>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.07,  -2.60,  -7.90>, < -0.30,  -1.77,  -7.60>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.68,  -0.94,  -7.29>, < -0.30,  -1.77,  -7.60>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -0.68,  -0.94,  -7.29>, < -1.05,  -0.11,  -6.99>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -1.42,   0.72,  -6.68>, < -1.05,  -0.11,  -6.99>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.68,  -0.94,  -7.29>, < -0.29,  -0.49,  -8.05>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.10,  -0.04,  -8.80>, < -0.29,  -0.49,  -8.05>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.68,  -0.94,  -7.29>, <  0.12,  -0.77,  -6.78>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.92,  -0.60,  -6.27>, <  0.12,  -0.77,  -6.78>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.92,  -0.60,  -6.27>, <  1.71,  -0.43,  -5.77>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.51,  -0.26,  -5.26>, <  1.71,  -0.43,  -5.77>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.10,  -0.04,  -8.80>, <  0.48,   0.41,  -9.56>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.87,   0.86, -10.31>, <  0.48,   0.41,  -9.56>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -1.42,   0.72,  -6.68>, < -1.79,   1.56,  -6.38>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.16,   2.39,  -6.07>, < -1.79,   1.56,  -6.38>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -2.16,   2.39,  -6.07>, < -2.53,   3.22,  -5.77>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -2.90,   4.05,  -5.46>, < -2.53,   3.22,  -5.77>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.16,   2.39,  -6.07>, < -1.77,   2.84,  -6.83>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -1.39,   3.29,  -7.58>, < -1.77,   2.84,  -6.83>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -2.16,   2.39,  -6.07>, < -1.36,   2.56,  -5.56>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -0.57,   2.72,  -5.05>, < -1.36,   2.56,  -5.56>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.57,   2.72,  -5.05>, <  0.23,   2.89,  -4.55>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  1.02,   3.06,  -4.04>, <  0.23,   2.89,  -4.55>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -1.39,   3.29,  -7.58>, < -1.00,   3.74,  -8.34>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.61,   4.19,  -9.09>, < -1.00,   3.74,  -8.34>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  2.36,  -2.46, -11.53>, <  2.74,  -2.01, -12.29>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  3.13,  -1.56, -13.04>, <  2.74,  -2.01, -12.29>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.36,  -2.46, -11.53>, <  3.15,  -2.29, -11.02>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  3.95,  -2.12, -10.51>, <  3.15,  -2.29, -11.02>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.36,  -2.46, -11.53>, <  1.99,  -1.63, -11.23>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  1.61,  -0.80, -10.92>, <  1.99,  -1.63, -11.23>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  3.95,  -2.12, -10.51>, <  4.75,  -1.96, -10.00>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  5.54,  -1.79,  -9.50>, <  4.75,  -1.96, -10.00>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  1.61,  -0.80, -10.92>, <  1.24,   0.03, -10.62>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.87,   0.86, -10.31>, <  1.24,   0.03, -10.62>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.87,   0.86, -10.31>, <  1.26,   1.31, -11.07>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  1.64,   1.76, -11.82>, <  1.26,   1.31, -11.07>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.87,   0.86, -10.31>, <  0.50,   1.69, -10.01>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.13,   2.52,  -9.70>, <  0.50,   1.69, -10.01>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.87,   0.86, -10.31>, <  1.67,   1.03,  -9.80>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  2.46,   1.20,  -9.29>, <  1.67,   1.03,  -9.80>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.46,   1.20,  -9.29>, <  3.26,   1.37,  -8.78>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  4.06,   1.54,  -8.28>, <  3.26,   1.37,  -8.78>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.13,   2.52,  -9.70>, < -0.24,   3.35,  -9.40>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.61,   4.19,  -9.09>, < -0.24,   3.35,  -9.40>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -0.61,   4.19,  -9.09>, < -0.23,   4.64,  -9.85>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.16,   5.09, -10.60>, < -0.23,   4.64,  -9.85>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.61,   4.19,  -9.09>, < -0.99,   5.02,  -8.79>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -1.36,   5.85,  -8.48>, < -0.99,   5.02,  -8.79>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.61,   4.19,  -9.09>, <  0.18,   4.35,  -8.58>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.98,   4.52,  -8.07>, <  0.18,   4.35,  -8.58>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.98,   4.52,  -8.07>, <  1.77,   4.69,  -7.56>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.57,   4.86,  -7.06>, <  1.77,   4.69,  -7.56>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  2.45,  -5.38,  -3.46>, <  3.25,  -5.22,  -2.95>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  4.04,  -5.05,  -2.44>, <  3.25,  -5.22,  -2.95>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.45,  -5.38,  -3.46>, <  2.84,  -4.93,  -4.21>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  3.22,  -4.48,  -4.97>, <  2.84,  -4.93,  -4.21>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.45,  -5.38,  -3.46>, <  2.08,  -4.55,  -3.15>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  1.71,  -3.72,  -2.85>, <  2.08,  -4.55,  -3.15>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  3.22,  -4.48,  -4.97>, <  3.61,  -4.03,  -5.72>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  4.00,  -3.59,  -6.48>, <  3.61,  -4.03,  -5.72>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  1.71,  -3.72,  -2.85>, <  1.34,  -2.89,  -2.54>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.96,  -2.06,  -2.24>, <  1.34,  -2.89,  -2.54>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.96,  -2.06,  -2.24>, <  1.35,  -1.61,  -2.99>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  1.74,  -1.16,  -3.75>, <  1.35,  -1.61,  -2.99>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.96,  -2.06,  -2.24>, <  0.59,  -1.23,  -1.93>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.22,  -0.40,  -1.63>, <  0.59,  -1.23,  -1.93>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.96,  -2.06,  -2.24>, <  1.76,  -1.89,  -1.73>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  2.56,  -1.72,  -1.22>, <  1.76,  -1.89,  -1.73>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  1.74,  -1.16,  -3.75>, <  2.12,  -0.71,  -4.50>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.51,  -0.26,  -5.26>, <  2.12,  -0.71,  -4.50>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.22,  -0.40,  -1.63>, < -0.15,   0.43,  -1.32>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.52,   1.26,  -1.02>, < -0.15,   0.43,  -1.32>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -0.52,   1.26,  -1.02>, < -0.14,   1.71,  -1.77>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.25,   2.16,  -2.53>, < -0.14,   1.71,  -1.77>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.52,   1.26,  -1.02>, < -0.89,   2.09,  -0.71>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {< -1.26,   2.93,  -0.41>, < -0.89,   2.09,  -0.71>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {< -0.52,   1.26,  -1.02>, <  0.27,   1.43,  -0.51>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  1.07,   1.60,   0.00>, <  0.27,   1.43,  -0.51>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  0.25,   2.16,  -2.53>, <  0.64,   2.61,  -3.28>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  1.02,   3.06,  -4.04>, <  0.64,   2.61,  -3.28>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  4.00,  -3.59,  -6.48>, <  3.62,  -2.75,  -6.17>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  3.25,  -1.92,  -5.87>, <  3.62,  -2.75,  -6.17>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  4.00,  -3.59,  -6.48>, <  4.38,  -3.14,  -7.23>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  4.77,  -2.69,  -7.99>, <  4.38,  -3.14,  -7.23>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  4.00,  -3.59,  -6.48>, <  4.79,  -3.42,  -5.97>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  5.59,  -3.25,  -5.46>, <  4.79,  -3.42,  -5.97>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  4.77,  -2.69,  -7.99>, <  5.16,  -2.24,  -8.74>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  5.54,  -1.79,  -9.50>, <  5.16,  -2.24,  -8.74>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  3.25,  -1.92,  -5.87>, <  2.88,  -1.09,  -5.56>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.51,  -0.26,  -5.26>, <  2.88,  -1.09,  -5.56>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  2.51,  -0.26,  -5.26>, <  3.31,  -0.09,  -4.75>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  4.10,   0.08,  -4.24>, <  3.31,  -0.09,  -4.75>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.51,  -0.26,  -5.26>, <  2.14,   0.57,  -4.95>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  1.77,   1.40,  -4.65>, <  2.14,   0.57,  -4.95>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.51,  -0.26,  -5.26>, <  2.90,   0.19,  -6.01>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  3.28,   0.64,  -6.77>, <  2.90,   0.19,  -6.01>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  3.28,   0.64,  -6.77>, <  3.67,   1.09,  -7.52>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  4.06,   1.54,  -8.28>, <  3.67,   1.09,  -7.52>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  1.77,   1.40,  -4.65>, <  1.40,   2.23,  -4.34>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  1.02,   3.06,  -4.04>, <  1.40,   2.23,  -4.34>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  1.02,   3.06,  -4.04>, <  0.65,   3.89,  -3.73>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  0.28,   4.73,  -3.43>, <  0.65,   3.89,  -3.73>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  1.02,   3.06,  -4.04>, <  1.82,   3.23,  -3.53>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  2.62,   3.40,  -3.02>, <  1.82,   3.23,  -3.53>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  1.02,   3.06,  -4.04>, <  1.41,   3.51,  -4.79>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  1.80,   3.96,  -5.55>, <  1.41,   3.51,  -4.79>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  1.80,   3.96,  -5.55>, <  2.18,   4.41,  -6.30>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.57,   4.86,  -7.06>, <  2.18,   4.41,  -6.30>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  5.54,  -1.79,  -9.50>, <  5.17,  -0.95,  -9.19>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  4.80,  -0.12,  -8.89>, <  5.17,  -0.95,  -9.19>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  5.54,  -1.79,  -9.50>, <  5.93,  -1.34, -10.25>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  6.32,  -0.89, -11.01>, <  5.93,  -1.34, -10.25>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  5.54,  -1.79,  -9.50>, <  6.34,  -1.62,  -8.99>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  7.14,  -1.45,  -8.48>, <  6.34,  -1.62,  -8.99>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  4.80,  -0.12,  -8.89>, <  4.43,   0.71,  -8.58>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  4.06,   1.54,  -8.28>, <  4.43,   0.71,  -8.58>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  4.06,   1.54,  -8.28>, <  4.85,   1.71,  -7.77>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  5.65,   1.88,  -7.26>, <  4.85,   1.71,  -7.77>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  4.06,   1.54,  -8.28>, <  3.69,   2.37,  -7.97>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  3.31,   3.20,  -7.67>, <  3.69,   2.37,  -7.97>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  4.06,   1.54,  -8.28>, <  4.44,   1.99,  -9.03>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
cylinder {<  4.83,   2.44,  -9.79>, <  4.44,   1.99,  -9.03>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  3.31,   3.20,  -7.67>, <  2.94,   4.03,  -7.36>, Rbond texture{pigment {color rgb <0.80, 0.10, 0.07> transmit 0.0} finish{ase3}}}
cylinder {<  2.57,   4.86,  -7.06>, <  2.94,   4.03,  -7.36>, Rbond texture{pigment {color rgb <0.84, 0.84, 0.86> transmit 0.0} finish{ase3}}}
// no constraints
