// CS of n·h.

//@ at highlight
lighting_highlight_blinn(n, l, v, scene_material.shininess)
