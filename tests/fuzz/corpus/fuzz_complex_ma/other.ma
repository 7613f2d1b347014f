# made elsewhere
4 3 1
v 0 0 0 1 7

v 1 0 0 1
v 0 1 0 1
v 0 0 1 .5
e 1 0 0 2
e 3 2
e 2 1
f 2 1 0 0
