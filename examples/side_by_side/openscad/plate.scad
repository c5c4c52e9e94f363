difference() {
    cube([90, 60, 4], center = true);
    for (x = [-30 : 20 : 30], y = [-15 : 15 : 15])
        translate([x, y, 0]) cylinder(h = 6, d = 5, center = true, $fn = 32);
}
