$fn = 32;
difference() {
    union() {
        cube([50, 40, 5]);
        cube([5, 40, 50]);
        translate([0, 22.5, 0]) rotate([90, 0, 0])
            linear_extrude(height = 5) polygon([[0, 0], [35, 0], [0, 35]]);
    }
    for (y = [8, 32]) {
        translate([38, y, -1]) cylinder(h = 7, d = 6);
        translate([-1, y, 38]) rotate([0, 90, 0]) cylinder(h = 7, d = 6);
    }
}
