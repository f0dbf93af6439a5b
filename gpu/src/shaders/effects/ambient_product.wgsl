// CA = LA * MA.

//@ at constant
sum += lighting_ambient(scene_ambient.color, scene_material.ambient);
