// CS of n·(v + l).

//@ at highlight
lighting_highlight_unnormalised(n, l, v, scene_material.shininess)
