// Times the regions of Apache Commons on two polygons, for scripts/lecture_peers.
//
// Standard input: for each polygon its number of corners, then x and y of each; the number of
// points, then x and y of each. Standard output: name and value, line by line; times in seconds of
// the thread's processor time, the best of all rounds.

import java.lang.management.ManagementFactory;
import java.util.Scanner;
import java.util.function.Supplier;
import org.apache.commons.math3.geometry.euclidean.twod.Euclidean2D;
import org.apache.commons.math3.geometry.euclidean.twod.PolygonsSet;
import org.apache.commons.math3.geometry.euclidean.twod.Vector2D;
import org.apache.commons.math3.geometry.partitioning.Region;
import org.apache.commons.math3.geometry.partitioning.RegionFactory;

public class CommonsRegions {
    private static final double TOLERANCE = 1e-10;
    private static final double SECONDS_PER_QUESTION = 2;

    public static void main(String[] arguments) {
        Scanner input = new Scanner(System.in).useLocale(java.util.Locale.ROOT);
        Vector2D[] a = points(input), b = points(input), asked = points(input);
        RegionFactory<Euclidean2D> factory = new RegionFactory<>();
        Supplier<PolygonsSet> make = () -> new PolygonsSet(TOLERANCE, a);
        PolygonsSet first = make.get(), second = new PolygonsSet(TOLERANCE, b);
        // An operation uses its operands up.
        Supplier<Region<Euclidean2D>> unite = () -> factory.union(first.copySelf(), second.copySelf());
        Region<Euclidean2D> union = unite.get();
        System.out.println("area " + union.getSize());
        System.out.println("inside " + inside(union, asked));
        System.out.println("build " + best(make));
        System.out.println("union " + best(unite));
        System.out.println("classify " + best(() -> inside(union, asked)));
    }

    private static Vector2D[] points(Scanner input) {
        Vector2D[] read = new Vector2D[input.nextInt()];
        for (int i = 0; i < read.length; i++) {
            read[i] = new Vector2D(input.nextDouble(), input.nextDouble());
        }
        return read;
    }

    private static long inside(Region<Euclidean2D> region, Vector2D[] points) {
        long count = 0;
        for (Vector2D point : points) {
            count += region.checkPoint(point) == Region.Location.INSIDE ? 1 : 0;
        }
        return count;
    }

    private static double best(Supplier<?> question) {
        double least = Double.MAX_VALUE, spent = 0;
        while (spent < SECONDS_PER_QUESTION) {
            long began = now();
            question.get();
            double took = (now() - began) * 1e-9;
            spent += took;
            least = Math.min(least, took);
        }
        return least;
    }

    private static long now() {
        return ManagementFactory.getThreadMXBean().getCurrentThreadCpuTime();
    }
}
