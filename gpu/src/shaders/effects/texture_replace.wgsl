// A texture in place of the colour.

//@ at textured
texel
