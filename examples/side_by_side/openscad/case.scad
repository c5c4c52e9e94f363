$fn = 32;
module outline(inset = 0) offset(6 - inset) square([68, 38], center = true);
difference() {
    linear_extrude(height = 30) outline();
    translate([0, 0, 2]) linear_extrude(height = 30) outline(2);
    translate([0, 0, 28]) linear_extrude(height = 3) outline(1);
}
