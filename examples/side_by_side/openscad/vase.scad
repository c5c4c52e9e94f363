linear_extrude(height = 60, twist = 90, slices = 60) circle(20, $fn = 6);
