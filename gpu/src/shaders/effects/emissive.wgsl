// CE.

//@ at constant
sum += scene_material.emissive;
