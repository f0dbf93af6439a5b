// A texture in place of the colour.

//@ at textured
color_replace(texel, color)
