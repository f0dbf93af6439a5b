// CA, a constant.

//@ at constant
sum += scene_ambient.color;
