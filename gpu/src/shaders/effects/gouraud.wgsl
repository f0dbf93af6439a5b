// Lit at the vertices.

//@ at varyings
@location(5) smooth_lit: vec3f,

//@ at vertex_lit
out.smooth_lit = lit;

//@ at lit
in.smooth_lit
