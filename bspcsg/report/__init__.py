"""Pages that open in any browser without a network: reports of campaigns, and views of meshes."""
