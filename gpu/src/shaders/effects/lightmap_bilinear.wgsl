// A lightmap, mixed from four texels.

//@ at lightmap_texel
texture_bilinear(scene_lightmap, in.lightmap_uv, scene_lightmap_reading.clamps == 1u)
