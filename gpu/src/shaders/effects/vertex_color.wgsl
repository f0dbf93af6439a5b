// Colours of the vertices.

//@ at vertex
@location(4) color: vec4f,

//@ at varyings
@location(6) color: vec4f,

//@ at vertex_out
out.color = in.color;

//@ at surface
color = color_modulate(in.color, color);
