profile = [[7, 1.5], [8.5, 0], [11.5, 0], [16, 2.6], [16, 10.4], [11.5, 13], [8.5, 13], [7, 11.5]];
intersection() {
    cylinder(h = 13, d = 24 / cos(30), $fn = 6);
    rotate_extrude($fn = 32) polygon(profile);
}
