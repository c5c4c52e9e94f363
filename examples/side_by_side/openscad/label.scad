cube([60, 16, 2], center = true);
linear_extrude(height = 2) text("Workshop", size = 8, halign = "center", valign = "center");
