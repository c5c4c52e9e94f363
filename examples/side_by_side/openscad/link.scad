$fn = 32;
difference() {
    hull() {
        translate([-20, 0, 0]) sphere(6);
        translate([20, 0, 0]) sphere(10);
    }
    translate([20, 0, 0]) cylinder(h = 30, r = 4, center = true);
}
