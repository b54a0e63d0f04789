// Made by scripts/write_options.py from include/singe/*.def: do not edit.
// Keys are those of scenes (docs/scene.md). Units are SI and kelvin.

/** Seeded noise from 0 to 1 over the sheet; scale in m is the size of its largest features. */
export interface Noise { scale: number; octaves?: number; seed?: number }
/** A grey picture over uv, 0 black to 1 white, its top row first. */
export interface Texture { width: number; height: number; values: Float32Array }
/** A parameter of a material: a number, or a pair between which noise or a picture leads. */
export type Param = number | { from: number; to: number; noise: Noise } | { from: number; to: number; texture: Texture };
export type Vector = readonly [number, number, number];
/** A position at a time, in m and s; positions between two keys lie on a straight line. */
export interface Key { time: number; position: Vector; rotation?: readonly [number, number, number, number] }

export interface SheetOptions {
    /** m/s, -1e6 to 1e6; at the start */
    velocity?: Vector;
    /** m2, >= 0; loose pieces smaller than this vanish; 0 keeps all */
    drop_pieces_below?: number;
}

export interface SourceOptions {
    /** ball: a hot ball on a path; spot: a hot ball that stands still; texture: a flux drawn on the sheet; arrival:
     *  a picture of the front's arrival times; water: a picture of where the sheet is wetted. These move air, which
     *  bends flames, carries sheets and cools them: jet from a nozzle, vortex about an axis, attract to a point,
     *  turbulence everywhere */
    kind?: "ball" | "texture" | "spot" | "arrival" | "water" | "jet" | "vortex" | "attract" | "turbulence";
    /** s, >= 0; time at which it starts */
    start?: number;
    /** s, >= 0; time at which it ends; inf: never */
    end?: number;
    /** K, ball and spot, 1 to 1e4; of the ball or flame */
    temperature?: number;
    /** W/(m2 K), ball and spot, 0 to 1e9; heat transfer coefficient to the sheet */
    conductance?: number;
    /** m, ball, spot, jet, vortex, attract and turbulence, 0 to 1e4; full heat within it; of a jet's nozzle; where
     *  a vortex or attraction is fastest; of turbulence's swirls */
    radius?: number;
    /** m, ball and spot, >= 0; beyond the radius, over which the heat falls to nothing */
    falloff?: number;
    /** W, ball and spot, 0 to 1e6; of a flame that it carries: the flame's gas rises and burns from its centre, if
     *  the scene has gas; a match has 60 W. It heats sheets through the gas alone */
    power?: number;
    /** W/m2, texture, -1e15 to 1e15; into each of the sheet's two layers where the texture is white; at most 1e15
     *  W/m2 after strength and the texture. Below 0 it cools, but not below 1 K */
    flux?: number;
    /** s, arrival, 0 to 1e9; when the front arrives where the map is black */
    arrival_from?: number;
    /** s, arrival, 0 to 1e9; when it arrives where the map is white; pure white never ignites */
    arrival_to?: number;
    /** s, arrival, 1e-3 to 1e6; how long before the front the sheet begins to scorch; longer makes a wider brown
     *  rim */
    lead?: number;
    /** kg/(m2 s), water, 0 to 1e6; water that falls where the picture is white, at the air's temperature. It needs
     *  a sheet with moisture above 0, which holds at most three times its own mass */
    wetting?: number;
    /** jet and vortex, -1e6 to 1e6; in which a jet blows; a vortex turns about it, counter-clockwise seen against
     *  it */
    direction?: Vector;
    /** m/s, jet, vortex, attract and turbulence, 0 to 1000; of the air, where it is fastest */
    speed?: number;
    /** m/s, jet, > 0; speed of the jet's air past a sheet from which on its flame gives the sheet no heat; it gives
     *  less from half of that on. inf: never */
    blow_out?: number;
}

export interface ColliderOptions {
    /** plane (its normal is its own z axis), sphere, box, capsule (along its own z axis), heightfield (solid below
     *  heights over a rectangle of its own x-y plane) or mesh (what a closed mesh encloses) */
    kind?: "plane" | "sphere" | "box" | "capsule" | "heightfield" | "mesh";
    /** m, sphere and capsule, 1e-6 to 1e4; of the sphere or the capsule */
    radius?: number;
    /** m, box, 1e-6 to 1e4; half of the box's lengths along its own axes */
    half_size?: Vector;
    /** m, capsule, 0 to 1e4; between the centres of the capsule's caps */
    height?: number;
    /** 0 to 1000; Coulomb's coefficient */
    friction?: number;
    /** m, 0 to 1000; distance that sheets keep from the surface */
    offset?: number;
    /** K, 1 to 1e4; matters when conductance is not 0 */
    temperature?: number;
    /** W/(m2 K), 0 to 1e9; heat exchanged in contact; 0 for none */
    conductance?: number;
    /** m, 0 to 1000; how near counts as contact for heat */
    contact_distance?: number;
    /** of a sheet's two layers in contact, touching: that which faces the collider exchanges heat; both: the one
     *  behind it as well, as if heat were through the sheet at once */
    sides?: "touching" | "both";
    /** m, heightfield, 1e-6 to 1e4; of the rectangle, from the first nodes to the last, along its own x and y */
    size?: readonly number[];
    /** yes: what burns within contact_distance, in either layer, gets no air and goes out */
    smothers?: boolean;
}

export interface PinOptions {
    /** m, 0 to 1e6; all particles within this distance of a point are held, and at least the vertex nearest to each
     *  point; a point that misses the sheet by a tenth of its diagonal is warned of */
    radius?: number;
    /** s, >= 0; time at which it lets go; what it held keeps its velocity; inf: never */
    end?: number;
}

export interface WindOptions {
    /** m/s, -1000 to 1000; mean velocity of the air */
    velocity?: Vector;
    /** m/s, 0 to 1000; amplitude of the gusts */
    gust?: number;
    /** s, 1e-6 to 1e6; how long a gust lasts */
    gust_time?: number;
    /** m, 1e-6 to 1e6; how far a gust reaches */
    gust_size?: number;
    /** seed of the gusts */
    seed?: number;
}

export interface SolverOptions {
    /** in this order: projection along strands; the paper's successive fast projection; the same exactly as
     *  printed, which may fail; all colours in one system; Hooke's law. The defaults below are those of strand */
    method?: "strand" | "paper" | "paper-literal" | "all-at-once" | "mass-spring";
    /** 0 to 1000; substeps of a step; stiff, thick sheets of small cells need more; 0: as many as the red
     *  compliance needs, and the weight of hanging sheets and the plume about them. If sheets may tear in gas and
     *  this is less than half of what that load needs, what it needs is taken */
    substeps?: number;
    /** 1 to 1000; projections of all colours per substep */
    projections?: number;
    /** order of the springs' colours, each once; the last is satisfied best */
    order?: readonly ("red" | "green" | "blue" | "yellow")[];
    /** 1e-6 to 1e6; floor on the solver's diagonal by colour of spring, relative to w_a + w_b = 2 */
    regularisation?: readonly number[];
    /** strand: keeps vertices within their geodesic distance of the pins */
    attachments?: boolean;
    /** paper, paper-literal, all-at-once: stops where the error is below tolerance of the lengths */
    early_exit?: boolean;
    /** 1e-12 to 1; the same: of the conjugate gradients and the early exit */
    tolerance?: number;
    /** N/m, 1e-6 to 1e9; mass-spring: of every spring */
    stiffness?: number;
    /** 1/s, 0 to 1e6; internal friction: rate at which second differences of velocity along strands are lost */
    smoothing?: number;
    /** m, 0 to 1000; distance of the nodes they are taken over; neighbours are always included */
    smoothing_length?: number;
    /** 0 to 1; smallest height of a cell's centre over its corners, in thicknesses; 0 is off, and cells may be
     *  inverted */
    height_min?: number;
    /** 0 to 1; share of a height's error that is corrected in a substep */
    height_gain?: number;
    /** yes: sharp bending is partly plastic, by the material's crease_radius and crease_share (solver strand); no:
     *  bending is elastic, as in the paper */
    creases?: boolean;
    /** sheets tear where the line force exceeds the material's strength; needs the method strand. Each sheet then
     *  has a reserve of vertices, which views show after its own vertices */
    tearing?: boolean;
    /** strand: yes: bending is the same in all directions of the mesh, by springs between centres across vertices,
     *  for cloth that drapes and sheets that curl; no: softest along the diagonals, as in the paper */
    isotropic?: boolean;
}

export interface GasOptions {
    /** no: sheets burn as in still air */
    enabled?: boolean;
    /** m, 0 to 1000; side of a cell of its grid; 0: 8.7 mm for a sheet of A4, in proportion to others */
    cell_size?: number;
    /** m, above 0, to 1000; height of the grid above the sheets at the start */
    height?: number;
    /** W/(m2 K), 0 to 1e9; heat transfer from hotter gas to each side of a sheet; a larger value makes fire climb
     *  faster */
    conductance?: number;
    /** 0 to 0.95; share of the flames' power that leaves as radiation */
    radiated?: number;
    /** 0 to 1; mass of smoke over the mass burnt */
    soot?: number;
}

export interface ContactOptions {
    /** no: sheets pass through themselves, as in the paper */
    enabled?: boolean;
    /** m, 1e-6 to 1; distance kept between surfaces, at most 2/5 of the smallest cell; not the material's
     *  thickness, which is the distance between the model's layers */
    thickness?: number;
    /** 0 to 1000; Coulomb's coefficient */
    friction?: number;
}

export interface SimOptions {
    /** 1 to 64; threads of the simulation's own pool */
    thread_count?: number;
    /** refused where the processor lacks them */
    instructions?: "best" | "plain" | "v2" | "v3" | "v4" | "neon" | "simd128";
    /** seed of ragged edges and of the preview; noise and wind have their own seeds */
    seed?: number;
    /** s, 1e-9 to 10; h of the paper */
    time_step?: number;
    /** 1 to 1000000; steps from a frame to the next: over them a surface's velocity is displacement over time */
    velocity_steps?: number;
    /** 1e-6 to 1e6; seconds of fire per second of motion; 1 is real, 4 burns four times as fast */
    pace?: number;
    /** m/s2, -1e4 to 1e4; z is up */
    gravity?: Vector;
    /** K, 1 to 1e4; temperature of the air and the surroundings */
    ambient_temperature?: number;
    /** kg/m3, 0 to 1000; for drag and wind */
    air_density?: number;
    /** 1e-9 to 1; relative tolerance of each sheet's heat equation; a step stops after 200 iterations and warns
     *  once */
    heat_tolerance?: number;
    /** m, 0 to 1000; resolution of the drawn mesh near the front: distance of the sample points, at least 1/23 of a
     *  cell's side. Bent cells are drawn on a smooth surface. 0: flat cells, sampled at their corners and centres,
     *  as in the paper */
    surface_detail?: number;
    /** m, 0 to 1000; maximum depth of noise at burnt edges, at most half a cell; needs detail */
    surface_raggedness?: number;
}

export interface MaterialOptions {
    /** kg/m2, 1e-6 to 1e6; mass per area before it burns */
    grammage?: Param;
    /** kg/m2, 0 to 1e6; diffusivity, layer_exchange, mass_rate and char_rate are given for this mass per area; on a
     *  lighter sheet they are larger in proportion, and its fire is faster. 0: they hold for any mass. One number
     *  for the whole sheet */
    reference_grammage?: number;
    /** J/(kg K), 1e-3 to 1e9; heat capacity of a kilogram */
    specific_heat?: Param;
    /** m, 1e-6 to 100; distance between the model's two layers; it sets the size of the wrinkles, and is larger
     *  than the real sheet's */
    thickness?: Param;
    /** surface: finite volumes in each layer; umbrella: the paper's eq 3, with springs' initial lengths; umbrella-
     *  live: eq 3 as printed, with the springs that are left and the lengths they have */
    heat_operator?: "surface" | "umbrella" | "umbrella-live";
    /** m2/s, >= 0; alpha of eq 2: thermal diffusivity in the sheet */
    diffusivity?: Param;
    /** 1/s, >= 0; rate at which the layers' temperatures equalise (surface only) */
    layer_exchange?: Param;
    /** W/(m2 K), >= 0; heat transfer to still air, per side */
    convection?: Param;
    /** 0 to 1; radiation relative to a black body */
    emissivity?: Param;
    /** above 0, to 1; the mass fraction by which heat losses are divided is at least this */
    loss_mass_floor?: Param;
    /** >= 0; widens the burning front this many times (1 or more) at the same speed, so that cells can hold it; 0:
     *  as little as the cells need; one number for the whole sheet */
    thickening?: number;
    /** K, 1 to 1e4; initial temperature */
    temperature?: Param;
    /** K, > 0; temperature above which the sheet burns */
    ignition_temperature?: Param;
    /** J/kg, >= 0; heat released per kilogram burnt */
    heat_of_combustion?: Param;
    /** 0 to 1; share of it that stays in the sheet; the rest goes into the flame. eta of eq 1, the temperature rise
     *  when all mass burns without losses, is heat_share heat_of_combustion/specific_heat */
    heat_share?: Param;
    /** 1/(K s), >= 0; mu of eq 4: mass lost per second and kelvin above ignition */
    mass_rate?: Param;
    /** K, > 0; temperature above ignition beyond which the burning rate stops growing, as air is limited; inf: as
     *  in the paper */
    rate_ceiling?: Param;
    /** >= 0; p: slows eq 4 near the end by ((m - m_min)/(1 - m_min))^p, so that flakes of ash stay; 0: as in the
     *  paper */
    ash_exponent?: Param;
    /** 0 to below 1; m_min: mass fraction that never burns */
    mass_min?: Param;
    /** 0 to below 1; m_loss: mass fraction below which the sheet is removed; if it is below mass_min, the sheet
     *  wrinkles but stays whole */
    mass_loss?: Param;
    /** > 0; density at mass_min over the density at the start; with mass_min it sets the shrinkage, eq 5 */
    ash_density?: Param;
    /** 0 to below 1; mass fraction that pyrolysis leaves as char, which is black and weak. Where it is hot and gets
     *  air, char glows and becomes grey ash, mass_min. At mass_min or below there is no char: one reaction, the
     *  paper's eq 4 */
    char_yield?: Param;
    /** > 0; density of char over the density at the start */
    char_density?: Param;
    /** J/kg, >= 0; heat released per kilogram of char that burns to CO2; all of it stays in the sheet. Hot embers
     *  burn to CO and release less */
    char_heat?: Param;
    /** 1/s, >= 0; share of hot char that burns per second at an edge; noise lets embers survive in some regions
     *  only */
    char_rate?: Param;
    /** 0 to 1; share of char_rate inside a leaf of char, away from edges and ash; lower values confine embers to
     *  edges */
    char_air?: Param;
    /** 0 to 2; factor on the shrinkage of the front layer (the upper side of a grid) */
    shrink_front?: Param;
    /** 0 to 2; the same for the back layer; a difference of 5 to 10 % curls the sheet towards the side that shrinks
     *  more */
    shrink_back?: Param;
    /** rad, -6.2831853 to 6.2831853; direction of the fibres: angle from the direction of increasing u (x on a
     *  grid) towards increasing v; without uv from the first side of each cell */
    fibre_angle?: Param;
    /** 0.1 to 10; ratio of the shrinkage across the fibres to that along them; 1: isotropic */
    fibre_shrink?: Param;
    /** no: burnt cells are not removed (Fig 4 b) */
    ablate?: boolean;
    /** 0 to 1; weight by colour of spring */
    weight?: readonly [Param, Param, Param, Param];
    /** >= 0; compliance by colour of spring */
    compliance?: readonly [Param, Param, Param, Param];
    /** 0 to 1; factor on the weight of springs that are burnt to mass_min */
    char_weight?: Param;
    /** >= 0; coefficient of air drag, quadratic in the speed along the normal */
    drag?: Param;
    /** 1/s, >= 0; damping of all motion */
    damping?: Param;
    /** m, >= 0; with creases: bending beyond this radius is partly plastic; 0: never. It applies to the model,
     *  which is ten times as thick as the real sheet */
    crease_radius?: Param;
    /** 0 to 1; share of the bend beyond that radius that is plastic; less in char, none in ash */
    crease_share?: Param;
    /** N/m, > 0; line force at which unburnt sheet tears; a texture may lower it at perforations and folds. The
     *  model's value is far below that of real paper */
    strength?: Param;
    /** N/m, > 0; the same for char, or without char for sheet burnt to mass_min; interpolated geometrically. Ash
     *  has a twentieth of it */
    char_strength?: Param;
    /** 1/s, >= 0; A: above 0, Arrhenius kinetics replace mass_rate: the mass that can still burn decreases at the
     *  rate A exp(-E/(R T)), of order ash_exponent, from ignition_temperature on */
    pre_exponential?: Param;
    /** J/mol, >= 0; E of the Arrhenius kinetics */
    activation_energy?: Param;
    /** 1/m, >= 0; max curvature of unburnt sheet beyond the rest shape (solver strand); 0: no limit. Without it
     *  thin sheets that shrink fold along rows of cells */
    curvature_max?: Param;
    /** 0 to 3; mass of water at the start over the mass before it burns; it boils off before the sheet gets hotter
     *  than 100 C. Paper in a room holds 5 to 8 %. 0: dry */
    moisture?: Param;
    /** N m, >= 0; bending stiffness D, moment per width over curvature: paper has 1e-4 to 1e-3 N m, cloth 1e-6 to
     *  1e-5. Above 0 it sets compliance.green to thickness^2/D, less compliance.blue; 0: compliance.green as it is,
     *  by default 1e-5 N m. Stiff sheets need substeps */
    bending?: Param;
    /** m, 0 to 1; what burns of other sheets within this distance of the sheet, in either layer, gets no air and
     *  goes out; 0: none. A blanket has 2 mm or so, and more than the contact's thickness, which sheets keep */
    smother_distance?: Param;
}
