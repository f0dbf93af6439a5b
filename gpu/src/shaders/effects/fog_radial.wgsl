// Fog by the distance from the eye.

//@ at fog_distance
fog_radial_distance(p)
