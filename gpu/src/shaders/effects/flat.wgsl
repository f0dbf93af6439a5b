// Lit once a face: the colour of the provoking vertex.

//@ at varyings
@location(4) @interpolate(flat, first) flat_lit: vec3f,

//@ at vertex_lit
out.flat_lit = lit;

//@ at lit
in.flat_lit
