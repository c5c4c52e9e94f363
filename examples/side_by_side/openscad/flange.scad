$fn = 32;
difference() {
    union() {
        cylinder(h = 14, d = 120);
        cylinder(h = 40, d = 60);
    }
    translate([0, 0, -1]) cylinder(h = 42, d = 45);
    for (k = [0 : 5]) rotate(60 * k) translate([45, 0, 0]) {
        translate([0, 0, -1]) cylinder(h = 16, d = 9);
        translate([0, 0, 9]) cylinder(h = 6, d = 15);
    }
}
