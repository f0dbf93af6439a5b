// CS of r·v.

//@ at highlight
lighting_highlight_phong(n, l, v, scene_material.shininess)
