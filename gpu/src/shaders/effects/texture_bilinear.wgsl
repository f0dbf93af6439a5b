// A texture, mixed from four texels.

//@ at texel
texture_bilinear(scene_texture, in.uv, scene_texture_reading.clamps == 1u)
