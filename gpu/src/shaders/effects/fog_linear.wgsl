// Linear fog.

//@ at fog_factor
fog_linear_factor(distance, scene_fog.dmin, scene_fog.dmax)
