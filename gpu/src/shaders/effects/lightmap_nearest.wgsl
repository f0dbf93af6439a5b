// A lightmap, read at the nearest texel.

//@ at lightmap_texel
texture_nearest(scene_lightmap, in.lightmap_uv, scene_lightmap_reading.clamps == 1u)
