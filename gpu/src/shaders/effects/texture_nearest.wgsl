// A texture, read at the nearest texel.

//@ at texel
texture_nearest(scene_texture, in.uv, scene_texture_reading.clamps == 1u)
