$fn = 32;
difference() {
    hull() for (x = [-17, 17], y = [-12, 12], z = [-3, 3]) translate([x, y, z]) sphere(3);
    cylinder(h = 20, d = 8, center = true);
}
