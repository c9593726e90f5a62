#!/usr/bin/env bash
# ranks.sh WEIR SCENES MPI_LIBRARY PART [MPIRUN]: weir run over several processes leaves what one process leaves, byte for byte; what cannot
# run so is refused; and however a run ends, it ends on all ranks. With MPIRUN, that of another MPI than the one weir was built with, and
# the library for that. Exit code 77 (skipped) where a part needs MPI and there is none.
set -uo pipefail
weir=$1 scenes=$2 library=$3 part=$4
export MPIRUN=${5:-mpirun}
size=${WEIR_TEST_SIZE:-ci}
# What ranks compute does not depend on what carries their messages. At ci size most parts use forked ranks; full size takes MPI everywhere.
# (CMakeLists.txt has the list of the others too: they run alone.)
case $part in
2d | particles_3d | petsc | ends | signals | busy) forked= ;;
*) forked=$([ "$size" = full ] || echo yes) ;;
esac
export FORKED=$forked
if [ -z "$FORKED" ]; then
    [ "$library" != off ] || { echo "skipped: WEIR_MPI is off"; exit 77; }
    package=$([ "$MPIRUN" = mpirun ] && echo openmpi || echo "${MPIRUN#mpirun.}")
    [ -n "$library" ] || { echo "skipped: built without MPI (Debian: apt-get install lib$package-dev)"; exit 77; }
    command -v "$MPIRUN" >/dev/null || { echo "skipped: no $MPIRUN (Debian: apt-get install ${package/openmpi/openmpi-bin})"; exit 77; }
fi
mpirun_sh=$(realpath "$(dirname "$0")/../support/mpirun.sh")
source "$mpirun_sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
if [ $# -gt 4 ]; then # weir looks beside itself first
    mkdir other
    ln "$weir" other/weir 2>/dev/null || cp "$weir" other/weir
    cp "$library" other/libweir_mpi.so
    weir=$work/other/weir
fi
export OMP_NUM_THREADS=1 GOMP_SPINCOUNT=0 OPENBLAS_NUM_THREADS=1 # all three: weir need not start itself again with them

fail() { echo "FAILED: $*"; tail -n 20 "$work"/log; exit 1; }
# ends CODE COMMAND...: the command ends with it, within a minute; forked ranks, which run beside other tests, within two
ends() {
    local wanted=$1 code=0
    shift
    timeout "$([ -n "$FORKED" ] && echo 120 || echo 60)" bash -c 'source "$0"; "$@"' "$mpirun_sh" "$@" </dev/null >"$work/log" 2>&1 || code=$?
    [ "$code" -eq "$wanted" ] || fail "ended with $code, not $wanted: $*"
}
says() { grep -q -- "$1" "$work/log" || fail "did not say: $1"; }
# files_differ ONE OTHER [EXCEPT]: those that do, but for run.json and timings.csv, which hold milliseconds
files_differ() { diff -rq --exclude run.json --exclude timings.csv ${3:+--exclude "$3"} "$1" "$2"; }
# alike ONE OTHER: the same files with the same bytes
alike() {
    local difference
    difference=$(files_differ "$1" "$2") && [ -e "$2/run.json" ] || fail "$2 is not as $1: $difference"
}
# compare NAME "RANKS THREADS, ..." SCENE [--set ...]: each against one process with one thread. At ci size two threads of two ranks, and one of
# more: six or eight threads on two cores wait most of their time. There three ranks stand for four,
# the slowest, beside others, except with keep_four=yes.
declare -A instead # of a run that was left out, the one with fewer ranks that checks look at
compare() {
    local name=$1 list=$2 pair before=
    shift 2
    set -- "$@" --checkpoint-every 1000 --quiet --set output.compression=none
    ends 0 "$weir" run "$@" --threads 1 --out "$name"
    while read -r -d, ranks threads; do
        if [ "$size" = ci ]; then
            threads=$((ranks == 2 ? 2 : 1))
            if [ "$ranks" -eq 4 ] && [ -n "$before" ] && [ -z "${keep_four:-}" ]; then
                instead[$name-4]=$name-3
                [ "$before" != "$name-3" ] || continue
                ranks=3
            fi
        fi
        rm -rf "$name-$ranks"
        ends 0 over "$ranks" "$weir" run "$@" --threads "$threads" --out "$name-$ranks"
        alike "$name" "$name-$ranks"
        before=$name-$ranks
    done <<<"$list,"
}
# the run that checks look at
ran() { echo "${instead[$1]:-$1}"; }

# in_two_parts MIDDLE END SCENE [--set ...]: saved by three ranks, continued by two, it ends as one process does that ran through
in_two_parts() {
    local middle=$1 end=$2
    shift 2
    rm -rf parts whole
    ends 0 over 3 "$weir" run "$@" --checkpoint-every 1000 --quiet --out parts --set time.end="$middle"
    ends 0 "$weir" run "$@" --checkpoint-every 1000 --quiet --threads 1 --out whole --set time.end="$end"
    ends 0 over 2 "$weir" run --restart parts --checkpoint-every 1000 --quiet --set time.end="$end"
    files_differ whole parts checkpoint.weir >log || fail "a run in two parts is another"
}

flat=$scenes/ranks.toml deep=$scenes/ranks_3d.toml drops=$scenes/ranks_particles.toml drops_deep=$scenes/ranks_particles_3d.toml
tall=$scenes/ranks_tall.toml tall_deep=$scenes/ranks_tall_3d.toml
water=$scenes/ranks_water.toml water_deep=$scenes/ranks_water_3d.toml one_end=$scenes/ranks_one_end.toml shallow=$scenes/ranks_shallow.toml columns=$scenes/ranks_columns.toml
gas=$scenes/ranks_two_phase.toml gas_deep=$scenes/ranks_two_phase_3d.toml
sea=$scenes/ranks_waves.toml trains=$scenes/ranks_trains.toml below=$scenes/ranks_waves_below.toml line=$scenes/ranks_line.toml
# without friction and a gauge; with every probe, some beside cuts; and with cells that a periodic axis can halve
frictionless=(--set 'effects={gravity={g=[0.5,-9.81]},surface_tension={sigma=0.07},volume_control={}}' --set 'fluid={density=1000.0}'
    --set 'probes=[{name="sums",kind="integral",field="volume"},{name="wall",kind="point",field="pressure",at=[0.2,0.3]}]')
probes=(--set 'probes=[{name="gauge",kind="gauge",at=[0.6,0.0]},{name="along",kind="front",axis="x"},{name="up",kind="front",axis="y"},
    {name="floor",kind="wall_pressure",at=[0.2,0.0]},{name="side",kind="wall_pressure",at=[0.0,0.475]},{name="ball",kind="wall_pressure",at=[0.42,0.3]}]')
probes_deep=(--set 'probes=[{name="gauge",kind="gauge",at=[0.2,0.0,0.26]},{name="x",kind="front",axis="x"},{name="y",kind="front",axis="y"},
    {name="z",kind="front",axis="z"},{name="floor",kind="wall_pressure",at=[0.1,0.0,0.26]},{name="ball",kind="wall_pressure",at=[0.25,0.15,0.28]}]')
probes_tall=(--set 'probes=[{name="gauge",kind="gauge",at=[0.2,0.0,0.26]},{name="x",kind="front",axis="x"},{name="y",kind="front",axis="y"},
    {name="z",kind="front",axis="z"},{name="floor",kind="wall_pressure",at=[0.1,0.0,0.26]},{name="ball",kind="wall_pressure",at=[0.3,0.15,0.18]},
    {name="sums",kind="integral",field="volume"},{name="high",kind="point",field="cell_height",at=[0.2,0.1,0.16]}]')
probes_gas=(--set 'probes=[{name="gauge",kind="gauge",at=[0.1,0.0,0.32]},{name="y",kind="front",axis="y"},{name="z",kind="front",axis="z"},
    {name="floor",kind="wall_pressure",at=[0.1,0.0,0.32]},{name="ball",kind="wall_pressure",at=[0.3,0.32,0.34]},{name="sums",kind="integral",field="poured_volume"}]')
# without solids, inflow and probes
closed='--set sides={} --set solids=[] --set probes=[]'
# some four cells a step, where a rank has four ghost planes as it begins
fast='--set initial.velocity={name="random",speed=4.0} --set time.dt=0.01 --set time.guard="off"'
even="--set grid.cells=[32,30,32] --set grid.size=[0.64,0.6,0.64]"
# from rest, and without a jet into air: there friction takes hundreds of iterations
viscous='--set fluid.viscosity=1e-4 --set effects.viscosity={} --set initial={} --set emitters=[]'
water_ring='--set sides={x_min={kind="periodic"},x_max={kind="periodic"},z_min={kind="periodic"},z_max={kind="periodic"}}'
basin='--set waves={model="basin"} --set liquid=[{shape="box",min=[0.0,-10.0,0.0],max=[80.0,0.0,40.0]},{shape="box",min=[0.0,-10.0,0.0],max=[50.0,-0.5,88.0]}]'
# what rank number 0, 1, .. of a run tells of itself, and a bound for it
told() { grep -o "\"$2\":\[[0-9,]*\]" "$1/run.json" | tr -d '[]' | cut -d: -f2 | cut -d, -f$(($3 + 1)); }
at_most() { [ "$1" -le "$2" ] || fail "$3: $1 bytes, and at most $2 are its own"; }
holds_own() {
    for run; do
        grep -q '"storage":"planes"' "$(ran "$run")/run.json" || fail "a rank of $run held more than its own planes"
    done
}
holds_whole() { grep -q '"storage":"replicated"' "$1/run.json" || fail "run.json of $1 does not tell that grids are whole"; }
# ends_steady RUN: the last run, and as many steps of this one, which were some
ends_steady() {
    says "steady at t = "
    [ "$(wc -l <"$1/steps.csv")" -gt 3 ] || fail "$1 was steady from the start"
}
# what was measured of a run, without times
measured() { grep -o '"measured": {[^}]*}' "$1/run.json" | tr '{,}' '\n\n\n' | grep -v '"ms_per_step"\|"seconds'; }
# measures_alike ONE OTHER
measures_alike() {
    local other
    other=$(ran "$2")
    [ -n "$(measured "$1")" ] && [ "$(measured "$1")" = "$(measured "$other")" ] || fail "$other measured $(measured "$other"), and $1 $(measured "$1")"
}
# continues RANKS FOLDER BESIDE [--set ...]: over so many, each of which reads its part of the checkpoint twice (it goes through it for the
# checksum, and gets what it owns), `beside` bytes more of its own where not all own as much, and less than 8 KiB that all read: names,
# sizes, the scene, clocks
continues() {
    local ranks=$1 folder=$2 beside=$3 rank size
    shift 3
    size=$(stat -c %s "$folder/checkpoint.weir")
    ends 0 over "$ranks" "$weir" run --restart "$folder" --checkpoint-every 1000 --quiet --threads 1 "$@"
    for rank in $(seq 0 $((ranks - 1))); do
        at_most "$(told "$folder" checkpoint_bytes "$rank")" $((2 * size / ranks + beside + 8192)) "read of $folder, rank $rank of $ranks"
    done
}
# continued_by_others ONE PARTS BESIDE4 BESIDE2 END: what four ranks have saved two continue, and at full size the other way round, as one
# process does
continued_by_others() {
    ends 0 "$weir" run --restart "$1" --checkpoint-every 1000 --quiet --threads 1 --set time.end="$5"
    continues 2 "$2-4" "$4" --set time.end="$5"
    alike "$1" "$2-4"
    [ "$size" = full ] || return 0
    continues 4 "$2-2" "$3" --set time.end="$5"
    alike "$1" "$2-2"
}
# poisoned RANKS THREADS SCENE [--set ...]: stale ghosts are not numbers, and nothing changes
poisoned() {
    local ranks=$1 threads=$2
    shift 2
    rm -rf clean poisoned
    ends 0 "$weir" run "$@" --checkpoint-every 1000 --quiet --threads 1 --out clean
    ends 0 over "$ranks" WEIR_HALO_POISON=1 "$weir" run "$@" --checkpoint-every 1000 --quiet --threads "$threads" --out poisoned
    alike clean poisoned
}
# what the solver of one process holds, and what the system has seen of a rank beyond what it sees of one with a few cells
holds() { grep -o '"solver_bytes": [0-9]*' "$1/run.json" | cut -d' ' -f2; }
peak_beyond() { echo $(($(told "$2" peak_bytes "$3") - $(told "$1" peak_bytes "$3"))); } # TINY FOLDER RANK
# shared SCENE PLANE_CELLS WHOLE RANKS FOLDER PARTS [--set ...]: of 256 planes each rank holds its part of what one process has in
# the folder: numbers 4 ghost planes on both sides, and one; bytes 11 (what is inside, layers, solids, known faces: less than 8 of them, 14 planes
# more than that); and so much that is whole
shared() {
    local scene=$1 plane=$2 whole=$3 ranks=$4 folder=$5 parts=$6 one rank
    shift 6
    one=$(holds "$folder")
    ends 0 over "$ranks" "$weir" run "$scene" --checkpoint-every 1000 --quiet --threads 1 --out "$parts" "$@"
    alike "$folder" "$parts"
    holds_own "$parts"
    for rank in $(seq 0 $((ranks - 1))); do
        at_most "$(told "$parts" solver_bytes "$rank")" $((one * (256 / ranks + 9) / 256 + 14 * 8 * plane + whole)) "$folder, rank $rank of $ranks"
    done
}
# peaks SCENE PLANE_CELLS BYTES RANKS PARTS TINY_CELLS: as the system sees it, at any time of a run of 256 planes, beyond what a run of a few
# cells takes, each of so many ranks has what it holds; so many bytes for each cell of its own planes; a page at both ends of less than 128
# arrays; what the first rank puts into a file at once; and two pages of 2 MiB, which the system may give for smaller ones
peaks() {
    local scene=$1 plane=$2 bytes=$3 ranks=$4 parts=$5 tiny=$6 rank
    ends 0 over "$ranks" "$weir" run "$scene" --quiet --threads 1 --out "tiny-$ranks" --set grid.cells="$tiny"
    for rank in $(seq 0 $((ranks - 1))); do
        at_most "$(peak_beyond "tiny-$ranks" "$parts" "$rank")" \
            $(($(told "$parts" solver_bytes "$rank") + bytes * plane * (256 / ranks) + 128 * 2 * 4096 + handed + 2 * huge_page)) "peak, rank $rank of $ranks"
    done
}
# pieces of a file between two ranks, and blocks that are being compressed
handed=$((4 * 1048576 + 2 * 8 * 32768)) huge_page=$((2 * 1048576))
# Of every number of ranks and threads a few; WEIR_TEST_SIZE=full takes all.
every="2 2,3 1,4 1"
[ "$size" = ci ] || every="1 2,2 1,2 2,3 1,3 2,4 1,4 2"
# of what each holds: most ranks hold the least
numbers=$([ "$size" = ci ] && echo 4 || echo "2 4")
sph="--set solver=sph --set time.end=0.02 --set output.every=0.01"
case $part in
2d)
    compare all "$every" "$flat"
    grep -q '"count":2,"partition":"planes","cut":\[0,72,152\]' all-2/run.json || fail "run.json does not tell the ranks"
    compare watched "2 1,3 2,4 1" "$flat" --set time.stop_when_steady=17 --set time.max_dt=0.005 --set time.cfl=0.5
    holds_own watched-2 watched-4
    ends_steady watched
    # what is measured of fields by their names is of own planes; what a metric of its own looks at is all of it
    norms="--measure velocity.l2_relative --measure velocity.linf --measure velocity.max --measure pressure.l1 --measure kinetic_energy.drift --measure divergence.max"
    vortices="$scenes/../../../cases/taylor_green/scene.toml --set grid.cells=[160,160] --set time.end=0.1 --reference taylor_green"
    compare norms "2 1,3 2,4 1" $vortices $norms
    for run in norms-2 norms-3 norms-4; do measures_alike norms $run; done
    holds_own norms-2 norms-4
    for advection in maccormack conservative; do
        compare stick-$advection "2 1,1 2" "$scenes/ranks_no_slip.toml" --set "scheme.advection=\"$advection\""
    done
    poisoned 3 1 "$scenes/ranks_no_slip.toml"
    compare energy "2 1" $vortices --measure flow.energy
    measures_alike energy energy-2
    holds_whole energy-2
    ;;
3d)
    compare all "$every" "$deep"
    compare stick "2 1,3 1" "$scenes/ranks_no_slip_3d.toml"
    compare pressed "2 1,3 2,4 1" "$deep" --set 'probes=[{name="side",kind="wall_pressure",at=[0.0,0.3,0.26]},{name="ball",kind="wall_pressure",at=[0.3,0.24,0.28]}]'
    holds_own pressed-3
    ;;
particles)
    compare pbf "$every" "$drops"
    compare sph "$every" "$drops" $sph
    grep -q '"count":2,"partition":"particles","storage":"particles"' pbf-2/run.json || fail "run.json does not tell the ranks"
    ;;
particles_3d)
    compare pbf "$every" "$drops_deep"
    compare sph "$every" "$drops_deep" $sph
    ;;
water)
    compare flip "$every" "$water" "${frictionless[@]}"
    holds_own flip-2
    grep -q '"replicated_work":\["small_pressure_levels"' flip-2/run.json || fail "run.json does not tell what is not shared"
    compare sticky "$every" "$water" "${probes[@]}"
    holds_own sticky-2
    compare few "4 2" "$scenes/water.toml"
    ;;
water_3d)
    compare flip "$every" "$water_deep"
    holds_own flip-4
    compare viscous "$every" "$water_deep" $viscous "${probes_deep[@]}"
    holds_own viscous-4
    grep -q '"viscous_iterations":{' viscous/run.json || fail "friction took no iterations"
    ;;
water_schemes)
    compare grid "3 1" "$water" "${frictionless[@]}" --set scheme.transfer=grid --set scheme.trace=rk3
    compare apic "3 2" "$water" --set scheme.transfer=apic --set scheme.poisson.method=cg_mic0
    compare ring "2 1,3 2" "$water_deep" $water_ring --set time.cfl=2 --set time.max_dt=0.05
    # of so few planes around a ring that a rank sees them all, and water that begins on one side of the seam
    few=$scenes/ranks_tall_pocket.toml
    seam='--set sides={z_min={kind="periodic"},z_max={kind="periodic"}} --set liquid=[{shape="box",min=[-0.1,-0.1,-1.0],max=[0.4,0.7,0.3]}] --set time.end=0.2'
    compare ring_of_few "2 1,4 1" "$few" $seam --set solver=mac_water
    compare ring_of_few_tall "2 1,4 1" "$few" $seam
    compare ring_apic "3 1" "$water_deep" $water_ring $even --set scheme.transfer=apic
    compare ring_own "2 1,4 1" "$water_deep" $water_ring $even --set time.cfl=2 --set time.max_dt=0.05
    holds_own ring_own-4
    compare ring_viscous "2 1,4 1" "$water_deep" $water_ring $even $viscous --set effects.viscosity.scheme=implicit
    compare whole_viscous "3 1" "$water_deep" $viscous --set scheme.poisson.method=cg_mic0
    holds_whole whole_viscous-3
    # a tank that rolls, also about axes that turn one rank's planes into another's
    for axis in x y z; do
        compare rolling_$axis "3 1" "$water_deep" --set emitters=[] --set "effects.rotating_frame={centre=[0.3,0.1,0.2],axis=\"$axis\",amplitude=0.3,period=0.4}"
    done
    compare flat_cells "2 2,3 1,4 1" "$water_deep" --set grid.cells=[28,40,26]
    holds_own flat_cells-3
    compare flat_ring "3 1" "$water_deep" $water_ring $viscous --set grid.cells=[28,30,32]
    in_two_parts 0.03 0.06 "$water_deep"
    ;;
water_cut) # planes are cut by what they hold: as the scene begins, as a restart finds it, and rebalanced at checkpoints
    told_cut() { grep -o '"cut":\[[0-9,]*\]' "$1/run.json" | cut -d: -f2; }
    is_cut() { [ "$(told_cut "$1")" = "$2" ] || fail "$1 is cut $(told_cut "$1"), not $2"; }
    keep_four=yes compare begun "$every" "$one_end"
    is_cut begun-2 '[0,16,80]' # 20 planes of liquid
    is_cut begun-4 '[0,8,16,24,80]'
    holds_own begun-4
    poisoned 3 1 "$one_end"
    in_two_parts 0.06 0.07 "$one_end"
    [ "$(told_cut parts)" != '[0,16,80]' ] || fail "a restart is cut as the scene began"
    ends 2 over 2 "$weir" run --restart parts --quiet --set time.end=0.08 --set grid.cells=[24,20,72]
    says "does not match the scene"
    # rebalanced at checkpoints; the last one changes nothing any more. How much the velocity has changed is watched across that.
    one_end="$one_end --set time.stop_when_steady=300"
    ends 0 "$weir" run $one_end --checkpoint-every 3 --quiet --threads 1 --out rebalanced
    for ranks in 2 4; do
        ends 0 over $ranks "$weir" run $one_end --checkpoint-every 3 --quiet --threads $((ranks == 2 ? 2 : 1)) --out rebalanced-$ranks
        alike rebalanced rebalanced-$ranks
    done
    [ "$(told_cut rebalanced-2)" != '[0,16,80]' ] || fail "nothing was repartitioned at a checkpoint"
    ends 0 over 3 WEIR_HALO_POISON=1 "$weir" run $one_end --checkpoint-every 3 --quiet --threads 1 --out rebalanced-3
    alike rebalanced rebalanced-3
    ;;
heightfield)
    compare shallow "$every" "$shallow"
    holds_own shallow-2 shallow-4
    compare columns "$every" "$columns"
    holds_own columns-2 columns-4
    around='--set sides={z_min={kind="periodic"},z_max={kind="periodic"},x_max={kind="wall"}}'
    compare ring "2 1,3 2" "$shallow" $around --set scheme.limiter=van_leer
    compare ring_columns "2 1,3 2" "$columns" $around
    compare thin "4 1" "$shallow" --set grid.cells=[37,1,6]
    compare thin_columns "4 1" "$columns" --set grid.cells=[37,1,5]
    for scene in "$shallow" "$columns"; do
        rm -rf fronts*
        compare fronts "2 1,3 2" "$scene" --set 'probes=[{name="x",kind="front",axis="x"},{name="y",kind="front",axis="y"},{name="z",kind="front",axis="z"}]'
        holds_own fronts-3
    done
    for case in "$shallow --set time.stop_when_steady=10" "$columns --set time.stop_when_steady=15"; do
        rm -rf watched*
        compare watched "2 1,3 2,4 1" $case
        holds_own watched-2 watched-4
        ends_steady watched
    done
    for scene in "$shallow" "$columns"; do
        in_two_parts 0.2 0.4 "$scene"
    done
    ;;
heightfield_2d) # one row of columns: replicated work, objects on it too
    for model in shallow_water columns; do
        compare $model "$every" "$line" --set scheme.model=$model
        grep -q '"cut":\[\]' $model-3/run.json || fail "run.json tells of a cut"
        grep -q '"replicated_work":\["everything"\]' $model-3/run.json || fail "run.json does not tell that every rank does all of it"
    done
    compare floats "2 1,3 2" "$line" --set scheme.model=columns --set 'floats=[{size=[0.5,0.2],at=[5.0,0.35]}]'
    in_two_parts 0.2 0.4 "$line"
    ;;
waves)
    compare sea "$every" "$sea"
    grep -q '"cut":\[0,16,44\]' sea-2/run.json || fail "run.json does not tell the ranks"
    holds_own sea-2 sea-4
    grep -q '"replicated_work":\[\]' sea-2/run.json || fail "run.json tells of what is not shared on a sea"
    compare trains "$every" "$trains"
    grep -q '"cut":\[0,8,22\]' trains-2/run.json || fail "run.json does not tell the ranks of layers"
    holds_own trains-2 trains-4
    compare below "2 1,3 2,4 1" "$below"
    holds_own below-4
    compare crest "2 1,3 2" "$sea" --set 'probes=[{name="crest",kind="front",axis="y"}]' --set waves.choppiness=0
    holds_own crest-2
    compare stokes "2 2,3 1" "$below" --set 'waves={model="stokes",height=1.0,wavelength=40.0,heading=0.5}'
    compare sines "3 1" "$below" --set 'waves={model="sines",trains=[{amplitude=0.5,wavelength=40.0,heading=1.0}]}'
    compare gerstner "2 1,3 2" "$below" --set 'waves={model="gerstner",trains=[{amplitude=0.5,wavelength=40.0,heading=1.0}]}'
    compare basin "$every" "$below" $basin \
        --set 'probes=[{name="below",kind="point",field="velocity",at=[50.0,-3.0,60.0]},{name="above",kind="point",field="level_set",at=[20.0,1.0,30.0]},
            {name="gauge",kind="gauge",at=[30.0,0.0,70.0]},{name="sums",kind="integral",field="potential_energy"}]'
    holds_own basin-2 basin-4
    grep -q '"replicated_work":\[\]' basin-2/run.json || fail "run.json tells of what is not shared in a basin"
    compare sheet "2 1,4 2" "$below" $basin --set grid.cells=[20,1,22]
    compare narrow "3 1" "$below" $basin --set grid.cells=[2,7,22] # fewer columns than ranks
    in_two_parts 0.2 0.6 "$below" $basin
    # in 2D a sea's row and the water below it; and fewer layers than ranks, where every rank does all of it
    sed -e 's/dim = 3/dim = 2/' -e 's/\[20, 7, 22\], size = \[80.0, 14.0, 88.0\], origin = \[0.0, -10.0, 0.0\]/[40, 9], size = [160.0, 18.0], origin = [0.0, -14.0]/' \
        -e 's/-9.81, 0.0/-9.81/; s/-3.0, 60.0/-3.0/; s/heading = 0.4, //' "$below" >row.toml
    compare row "2 2,3 1,4 1" row.toml
    compare row_basin "3 1" row.toml --set 'waves={model="basin"}' --set 'liquid=[{shape="wave",level=0.0,amplitude=0.5,wavelength=160.0}]'
    grep -q '"replicated_work":\["surface_row"\]' row_basin-3/run.json || fail "run.json does not tell what is not shared in 2D"
    compare surface "3 2" row.toml --set grid.cells=[40,1] --set probes=[]
    grep -q '"replicated_work":\["everything"\]' surface-3/run.json || fail "run.json does not tell that every rank does all of it"
    for scene in "$sea" "$trains"; do
        in_two_parts 0.2 0.6 "$scene"
    done
    ;;
tallcell)
    compare deep "$every" "$tall_deep"
    holds_own deep-2 deep-4
    grep -q '"replicated_work":\["small_pressure_levels","level_set_in_solids"\]' deep-2/run.json || fail "run.json does not tell what is not shared"
    compare flat "2 1,3 2,4 1" "$tall"
    tall_ring='--set sides={x_min={kind="periodic"},x_max={kind="periodic"},z_min={kind="periodic"},z_max={kind="periodic"}}'
    clear='--set solids=[]' # columns are looked at together where no solid cuts them
    # paths of two cells around the ends of the cut axis, in steps that advection allows
    compare ring "2 1,3 2,4 1" "$tall_deep" $tall_ring $clear --set time.cfl=3 --set time.max_dt=0.05 \
        --set 'initial.velocity={name="random",speed=2.0}' --set 'effects={gravity={g=[0.0,-9.81,0.0]}}'
    holds_own ring-4
    # farther than a step of the scene's CFL number goes, without and around the ends
    compare fast "3 1,4 2" "$tall_deep" $fast
    compare fast_ring "3 2" "$tall_deep" $tall_ring $clear $fast
    holds_own fast-4 fast_ring-3
    compare probed "2 1,3 2" "$tall_deep" "${probes_tall[@]}" --set 'output.surface={method="level_set"}'
    holds_own probed-3
    compare watched "2 1" "$tall_deep" --set time.stop_when_steady=1e-9
    holds_own watched-2
    compare single "3 1" "$tall_deep" $clear --set scheme.columns=single --set scheme.advection=semi_lagrangian
    compare uniform "3 2" "$tall_deep" --set scheme.columns=uniform
    compare lines "2 1,4 2" "$tall_deep" $clear --set grid.cells=[32,48,26] --set grid.size=[0.64,0.96,0.52]
    compare lying "3 1" "$tall_deep" --set 'effects={gravity={g=[-9.81,0.0,0.0]}}'  # columns along x
    compare across "3 1" "$tall_deep" --set 'effects={gravity={g=[0.0,0.0,-9.81]}}' # columns through all slabs: every rank does all
    holds_whole across-3
    compare thin "4 1" "$tall_deep" --set grid.cells=[28,48,9] --set grid.size=[0.56,0.96,0.18]
    compare few "4 1" "$tall_deep" --set grid.cells=[28,48,7] --set grid.size=[0.56,0.96,0.14] # no pair of lines for each
    grep -q '"replicated_work":\["everything"\]' few-4/run.json || fail "run.json does not tell that every rank does all of it"
    # two levels of the pressure that are cut, and one with an odd number of lines around
    compare levels "2 1,4 2" "$tall_deep" $clear --set grid.cells=[64,32,64] --set grid.size=[1.28,0.64,1.28] --set scheme.columns=uniform --set time.end=0.03
    compare odd "3 1" "$tall_deep" $tall_ring $clear --set grid.cells=[27,48,25] --set grid.size=[0.54,0.96,0.5]
    compare flat_cells "3 1" "$tall_deep" --set grid.cells=[28,60,26]
    compare pocket "2 1,3 2,4 1" "$scenes/ranks_tall_pocket.toml" # sets of knots that are one across the cuts
    holds_own pocket-4
    for scene in "$tall" "$tall_deep"; do
        in_two_parts 0.03 0.06 "$scene"
    done
    ;;
two_phase) # liquid and gas
    tension='effects={surface_tension={sigma=0.07}}'
    falling='effects={gravity={g=[0.5,-9.81]},surface_tension={sigma=0.07}}'
    flat_ring='sides={x_min={kind="periodic"},x_max={kind="periodic"},y_min={kind="periodic"},y_max={kind="periodic"}}'
    blown='sides={z_min={kind="inflow",velocity=[0.0,0.0,0.5],fluid="gas"},z_max={kind="outflow"},x_max={kind="inflow",velocity=[-0.3,0.0,0.0]}}'
    compare ball "$every" "$gas" "${probes[@]}"
    holds_own ball-2 ball-4
    grep -q '"replicated_work":\["small_pressure_levels"\]' ball-2/run.json || fail "run.json does not tell what is not shared"
    compare deep "$every" "$gas_deep" $even
    holds_own deep-2 deep-4
    compare few "2 1,4 1" "$gas_deep" # cells that the periodic axis cannot halve: the pressure is solved by every rank
    holds_whole few-2
    compare dam "2 1,4 1" "$scenes/../../../cases/dam_break_gas/scene.toml" --set grid.cells=[216,96] --set grid.size=[0.3429,0.1524] --set time.end=0.02
    holds_own dam-2
    compare drop "2 1,4 1" "$gas" $closed --set 'liquid=[{shape="sphere",centre=[0.45,0.475],radius=0.2}]' --set "$tension" --set time.end=0.03
    holds_own drop-2
    compare bubble "3 1" "$gas" $closed --set "$flat_ring" --set "$falling" \
        --set 'liquid=[{shape="difference",from={shape="box",min=[-1.0,-1.0],max=[2.0,0.7]},minus=[{shape="sphere",centre=[0.45,0.475],radius=0.2}]}]'
    compare blown "2 1,4 1" "$gas_deep" $even --set "$blown" --set 'effects={gravity={g=[0.0,-9.81,1.0]}}' \
        --set 'solids=[{shape="sphere",centre=[0.3,0.2,0.34],radius=0.12}]' "${probes_gas[@]}"
    holds_own blown-4
    compare rolling "2 1,3 1" "$gas" $closed --set 'effects={gravity={g=[0.0,-9.81]},rotating_frame={centre=[0.3,0.1],amplitude=0.3,period=0.4}}'
    compare alone "3 1" "$gas" --set scheme.poisson.method=cg_mic0
    holds_whole alone-3
    keep_four=yes compare thin "4 1" "$gas" $closed --set grid.cells=[24,5] --set grid.size=[0.9,0.2] --set "$falling"
    # so many bubbles that the pressure takes aggregates by phase, on every rank
    bubbles=$(for j in 1 2 3 4; do for i in 1 2 3 4; do echo "{shape=\"sphere\",centre=[0.$((2 * i)),0.$((2 * j))],radius=0.05}"; done; done | paste -sd,)
    compare cloud "3 1" "$gas" $closed --set "liquid=[$bubbles]" --set fluid.density=1.0 --set gas.density=1000.0 --set time.end=0.006
    in_two_parts 0.006 0.012 "$gas"
    in_two_parts 0.004 0.008 "$gas_deep" $even
    # bytes of each rank: arrays with at most 5 ghost planes on both sides and one plane of faces, and what is whole: the pressure's levels of
    # fewer than 20,000 cells, less than 128 bytes each, and 5 bytes per cell for the connected regions of gas
    cat >tank.toml <<-END
	solver = "two_phase"
	dim = 3
	grid = { cells = [24, 24, 256], size = [0.24, 0.24, 2.56] }
	time = { end = 0.001, dt = 0.001 }
	fluid = { density = 1000.0 }
	gas = { density = 1.2 }
	liquid = [ { shape = "box", min = [0.0, 0.0, 0.0], max = [0.24, 0.12, 2.56] } ]
	effects = { gravity = { g = [0.5, -9.81, 1.0] }, surface_tension = { sigma = 0.07 } }
	output = { every = 1.0 }
	END
    ends 0 "$weir" run tank.toml --checkpoint-every 1000 --quiet --threads 1 --out tank
    for ranks in $numbers; do shared tank.toml $((24 * 24)) $((20000 * 8 / 7 * 128 + 5 * 24 * 24 * 256)) "$ranks" tank "tank-$ranks"; done
    poisoned 3 1 "$gas"
    poisoned 3 1 "$gas_deep" $even
    poisoned 4 1 "$gas_deep" # at most 8 planes each, and heights read 5
    ;;
particles_schemes)
    compare tolerant "3 2" "$drops" --set scheme.tolerance=1e-3 --set scheme.warm_start=0.4 --set scheme.kernel=muller --set effects.artificial_pressure.k=1e-4
    compare summed "3 1" "$drops" $sph --set scheme.density=summation --set scheme.tension=true --set effects.surface_tension.sigma=0.07
    compare viscous "4 1" "$drops_deep" $sph --set fluid.viscosity=1e-3 --set effects.viscosity={} --set effects.density_diffusion={}
    compare few "4 1" "$scenes/particles.toml"
    # around the ends of every axis: images of images, in cells that a rank has not beside its own
    ring='x_min={kind="periodic"},x_max={kind="periodic"},y_min={kind="periodic"},y_max={kind="periodic"}'
    ring_deep="$ring,z_min={kind=\"periodic\"},z_max={kind=\"periodic\"}"
    compare ring "2 1,3 2" "$drops" --set "sides={$ring}"
    compare ring_sph "4 1" "$drops" $sph --set "sides={$ring}"
    compare ring_deep "3 1" "$drops_deep" --set "sides={$ring_deep}"
    compare ring_deep_sph "4 1" "$drops_deep" $sph --set "sides={$ring_deep}"
    in_two_parts 0.04 0.08 "$drops"
    ;;
schemes)
    periodic='--set sides={x_min={kind="periodic"},x_max={kind="periodic"},y_min={kind="periodic"},y_max={kind="periodic"}} --set emitters=[]'
    compare ring "2 1,3 2" "$flat" $periodic --set scheme.interpolation=monotone_cubic --set time.cfl=6 --set time.max_dt=0.04
    # paths of several cells around the ends of the cut axis, beside a ball
    compare ring_3d "3 1" "$deep" --set 'sides={x_min={kind="periodic"},x_max={kind="periodic"},z_min={kind="periodic"},z_max={kind="periodic"}}' \
        --set grid.cells=[32,30,32] --set grid.size=[0.64,0.6,0.64] --set 'initial.velocity={name="random",speed=3.0}' --set time.cfl=8
    holds_own ring_3d-3
    compare fluxes "3 1" "$flat" --set scheme.advection=conservative
    compare paths "3 1" "$flat" --set scheme.advection=semi_lagrangian --set effects.viscosity.scheme=implicit
    compare alone "3 1" "$flat" --set scheme.poisson.method=cg_mic0 --set time.end=0.04
    compare small "4 1" "$flat" --set grid.cells=[16,5]
    ;;
moving) # solids on a way that the scene tells, which leads through cuts, and one that turns in one
    stirs='solids=[{shape="sphere",centre=[0.45,0.45],radius=0.1,motion={kind="sinusoidal",amplitude=[0.02,0.1],frequency=3.0}}]'
    stirs_deep='solids=[{shape="sphere",centre=[0.3,0.2,0.26],radius=0.1,motion={kind="sinusoidal",amplitude=[0.0,0.02,0.08],frequency=3.0}},
        {shape="box",min=[0.05,0.02,0.08],max=[0.12,0.3,0.3],motion={kind="rotation",rate=6.0,axis=[0.0,1.0,0.0],centre=[0.1,0.1,0.2]}}]'
    compare smoke "2 1,4 2" "$scenes/smoke.toml"
    compare paths "3 2,4 1" "$flat" --set "$stirs"
    holds_own paths-3
    compare fluxes "3 1" "$flat" --set "$stirs" --set scheme.advection=conservative
    compare deep "2 2,4 1" "$deep" --set "$stirs_deep" --set 'probes=[{name="ball",kind="wall_pressure",at=[0.3,0.1,0.26]}]'
    holds_own deep-4
    compare whole "3 1" "$deep" --set "$stirs_deep" --set scheme.poisson.method=cg_mic0
    holds_whole whole-3
    compare water "3 2,4 1" "$water" --set "$stirs"
    holds_own water-3
    compare water_deep "2 2,4 1" "$water_deep" --set "$stirs_deep"
    holds_own water_deep-4
    compare water_ring "3 2" "$water_deep" $water_ring $even --set "$stirs_deep" --set scheme.transfer=apic
    compare water_viscous "3 1" "$water_deep" $viscous --set "$stirs_deep"
    compare water_whole "3 1" "$water_deep" --set "$stirs_deep" --set scheme.poisson.method=cg_mic0
    holds_whole water_whole-3
    compare tall "3 1" "$tall" --set "$stirs"
    compare tall_deep "2 2,4 1" "$tall_deep" --set "$stirs_deep"
    holds_own tall_deep-4
    for scene in "$deep" "$water_deep" "$tall_deep"; do
        in_two_parts 0.03 0.06 "$scene" --set "$stirs_deep"
        poisoned 3 1 "$scene" --set "$stirs_deep"
    done
    ;;
surfaces | surfaces_water) # the liquid's surface, which all make together, by every reconstruction
    by() { echo "--set output.surface={method=\"$1\"${2:-}} --set output.every=0.03 --set time.end=0.03"; }
    has_surface() { [ "$(ls "$1"/frames/liquid_surface_*.vtp | wc -l)" -ge 2 ] || fail "$1 has no surfaces"; }
    if [ $part = surfaces ]; then
        for method in zhu_bridson anisotropic density; do
            compare $method "$every" "$drops" $(by $method)
            has_surface $method
            compare $method-deep "2 1,3 2,4 1" "$drops_deep" $(by $method)
        done
        compare sph "2 2,3 1" "$drops_deep" $sph $(by density)
        # as VTK's filters count, with several threads; and around the ends of the cut axis
        compare threads "1 2,2 2,4 2" "$drops_deep" $(by density ,cell=0.5)
        compare ring "3 1" "$drops_deep" --set 'sides={z_min={kind="periodic"},z_max={kind="periodic"}}' $(by anisotropic)
        poisoned 3 1 "$drops" $(by density)
        poisoned 3 1 "$drops_deep" $(by density)
        exit 0
    fi
    for method in zhu_bridson anisotropic density; do
        compare $method "2 1,3 2" "$water" $(by $method)
        holds_own $method-3
    done
    compare deep "2 2,4 1" "$water_deep" $(by density)
    has_surface deep
    holds_own deep-4
    compare whole "3 1" "$water" $(by zhu_bridson) --set scheme.poisson.method=cg_mic0
    holds_whole whole-3
    compare grid "2 1,3 2" "$water" $(by zhu_bridson) --set scheme.transfer=grid
    compare set "$every" "$water" $(by level_set)
    has_surface set
    holds_own set-4
    compare set-deep "$every" "$water_deep" $(by level_set)
    holds_own set-deep-4
    compare tall-deep "2 1,3 2" "$tall_deep" $(by level_set)
    compare tall "3 1" "$tall" $(by level_set)
    poisoned 3 1 "$water" $(by density)
    poisoned 3 1 "$water_deep" $(by density)
    ends 0 over 2 "$weir" run "$water" $(by level_set) --explain
    says "surface reconstruction by level_set, per frame"
    ;;
storage) # each rank holds its own planes and those near its cuts, by its own count and as the system sees it
    cat >plume.toml <<-END
	solver = "mac"
	dim = 3
	grid = { cells = [48, 48, 256], size = [0.48, 0.48, 2.56] }
	time = { end = 0.003, max_dt = 0.001 }
	effects = { buoyancy = { alpha = 0.1, beta = 0.2, ambient = 293.0 }, confinement = { epsilon = 0.2 } }
	emitters = [ { shape = "sphere", centre = [0.25, 0.15, 1.24], radius = 0.1, smoke = 1.0, temperature = 343.0 } ]
	output = { every = 1.0 }
	END
    ends 0 "$weir" run plume.toml --checkpoint-every 1000 --quiet --threads 1 --out one
    one=$(holds one)
    cells=$((48 * 48)) # of a plane
    for ranks in $numbers; do
        ends 0 over $ranks "$weir" run plume.toml --checkpoint-every 1000 --quiet --threads 1 --out parts-$ranks
        alike one parts-$ranks
        holds_own parts-$ranks
        for rank in $(seq 0 $((ranks - 1))); do
            # Nothing crosses a cell in a step: 4 ghost planes on both sides, and one. Whole are the pressure's levels of fewer than 20,000 cells,
            # of 8/7 as many in all: 4 vectors, 1/diagonal, 6 weights of half the cells, faces, what leads to p = 0, flags: less than 64
            # bytes per cell in rows twice as long as they are full.
            at_most "$(told parts-$ranks solver_bytes $rank)" $((one * (256 / ranks + 9) / 256 + 20000 * 8 / 7 * 128)) "rank $rank of $ranks"
        done
        # The last good state and a checkpoint beside it: 3 + 1 + 2 numbers and a flag a cell, each; and of a frame the own part of its largest
        # array, three numbers a cell. A whole frame has 48 bytes per cell.
        peaks plume.toml $cells $((2 * 49 + 24)) $ranks parts-$ranks [8,8,32]
    done
    # Particles: a column of 512 layers of 64. Cells are two spacings wide; the first of an axis holds 3. A rank knows at most 3 layers, a row
    # and a cell of ghosts on both sides.
    cat >column.toml <<-END
	solver = "sph"
	dim = 3
	grid = { cells = [8, 8, 520], size = [0.08, 0.08, 5.2] }
	time = { end = 0.004, dt = 1e-4 }
	scheme = { support = 2.0 }
	liquid = [ { shape = "box", min = [0.0, 0.0, 0.0], max = [0.08, 0.08, 5.12] } ]
	output = { every = 1.0 }
	END
    for solver in sph pbf; do
        column=(column.toml --checkpoint-every 1000 --quiet --threads 1 --set solver=$solver)
        [ $solver = pbf ] && column+=(--set scheme={} --set time.dt=2e-3)
        ends 0 "$weir" run "${column[@]}" --out $solver
        whole=$(holds $solver) layers=$((512 * 64))
        # a cell is as wide as the support: two spacings, or what pbf has without being told
        deep=$([ $solver = sph ] && echo 3 || echo 5) beside=$((2 * (deep * 64 + deep * deep * 8 + deep * deep * deep)))
        for ranks in $numbers; do
            ends 0 over $ranks "$weir" run "${column[@]}" --out $solver-$ranks
            alike $solver $solver-$ranks
            for rank in $(seq 0 $((ranks - 1))); do
                # Arrays have a sixteenth of room; messages hold 8 numbers of each that is shown, sent and got; and of the cells beside its own,
                # less than 4 planes of 16, where each begins and how many are in it, with half as much room.
                at_most "$(told $solver-$ranks solver_bytes $rank)" \
                    $((whole * (layers / ranks + beside) / layers * 17 / 16 + 2 * 8 * 8 * beside + 12 * 4 * 16)) "$solver, rank $rank of $ranks"
            done
        done
        continued_by_others $solver $solver 0 0 0.008
    done
    # a rank whose last face of the cut axis is the domain's has a plane of 8 bytes per face more
    continued_by_others one parts $((8 * cells)) $((8 * cells)) 0.004
    ;;
storage_water) # the same of liquid with markers, as much of it in every plane
    cat >pool.toml <<-END
	solver = "mac_water"
	dim = 3
	grid = { cells = [32, 32, 256], size = [0.32, 0.32, 2.56] }
	time = { end = 0.003, max_dt = 0.001 }
	liquid = [ { shape = "box", min = [0.0, 0.0, 0.0], max = [0.32, 0.16, 2.56] } ] # and walls at both ends of the cut axis
	solids = [ { shape = "cylinder", from = [0.16, 0.05, -0.1], to = [0.16, 0.05, 2.7], radius = 0.04 } ]
	initial.velocity = { name = "random", speed = 0.1 }
	effects = { surface_tension = { sigma = 0.07 }, volume_control = {} }
	output = { every = 1.0 }
	END
    cells=$((32 * 32)) # of a plane
    # the pressure's small levels as above; lists of all rows and of runs of liquid: less than 64 bytes of each row
    pool="pool.toml $cells $((20000 * 8 / 7 * 128 + 64 * 32 * 256))"
    ends 0 "$weir" run pool.toml --checkpoint-every 1000 --quiet --threads 1 --out one
    for ranks in $numbers; do
        shared $pool $ranks one parts-$ranks
        # The last good state and a checkpoint beside it: 3 + 1 + 1 numbers, a flag and a layer of a cell, 6 numbers of 8 markers in each of the
        # lower half, each; and of a frame the own part of its largest array, three numbers a marker. A whole frame has 40 bytes per cell and 48
        # a marker.
        peaks pool.toml $cells $((2 * (42 + 4 * 6 * 8) + 4 * 3 * 8)) $ranks parts-$ranks [8,8,64]
    done
    # of friction too: weights, vectors and lists of faces; of a pool that begins to slosh
    slosh="$viscous --set effects.gravity.g=[1.0,-9.81,0.0]"
    ends 0 "$weir" run pool.toml --checkpoint-every 1000 --quiet --threads 1 --out viscous $slosh
    for ranks in $numbers; do shared $pool $ranks viscous viscous-$ranks $slosh; done
    # in cells that are no cubes, half as many along x
    ends 0 "$weir" run pool.toml --checkpoint-every 1000 --quiet --threads 1 --out flat --set grid.cells=[16,32,256]
    for ranks in $numbers; do shared $pool $ranks flat flat-$ranks --set grid.cells=[16,32,256]; done
    # a rank whose last face of the cut axis is the domain's has a plane of 8 bytes per face more; and before anything is made, each looks
    # at its share of the level set, 8 bytes per cell, to find where planes are cut
    continued_by_others one parts $((8 * cells + 8 * cells * 256 / 4)) $((8 * cells + 8 * cells * 256 / 2)) 0.004
    ;;
storage_tall) # the same of tall cells: planes of the lattice, and lines of the pressure's matrix and of its levels
    cat >deep.toml <<-END
	solver = "tallcell"
	dim = 3
	grid = { cells = [32, 48, 256], size = [0.32, 0.48, 2.56] }
	time = { end = 0.003, max_dt = 0.001 }
	liquid = [ { shape = "box", min = [0.0, 0.0, 0.0], max = [0.32, 0.4, 2.56] } ]
	solids = [ { shape = "cylinder", from = [0.16, 0.05, -0.1], to = [0.16, 0.05, 2.7], radius = 0.04 } ]
	initial.velocity = { name = "random", speed = 0.1 }
	effects = { gravity = { g = [0.0, -9.81, 0.0] }, volume_control = {} }
	output = { every = 1.0 }
	END
    cells=$((32 * 48)) # of a plane
    # Lines have 2 ghosts on both sides. Whole are the pressure's levels of fewer than 20,000 unknowns, of 4/3 as many in all: 9 numbers, 11 of single
    # precision and a flag, less than 128 bytes, in rows half as long again; and of a row of cells where the band begins and ends in it.
    deep="deep.toml $cells $((20000 * 4 / 3 * 128 * 3 / 2 + 8 * 48 * 256))"
    ends 0 "$weir" run deep.toml --checkpoint-every 1000 --quiet --threads 1 --out one
    for ranks in $numbers; do
        shared $deep $ranks one parts-$ranks
        # The last good state and a checkpoint beside it: 3 + 1 + 1 numbers, a flag and a layer of a cell, each; and of a frame the own part of
        # its largest array, three numbers a cell. A whole frame has 48 bytes per cell.
        peaks deep.toml $cells $((2 * 42 + 24)) $ranks parts-$ranks [8,12,64]
    done
    # where the pressure is most of it: no tall cell anywhere
    regular='--set scheme.columns=uniform --set solids=[]'
    ends 0 "$weir" run deep.toml --checkpoint-every 1000 --quiet --threads 1 --out regular $regular
    for ranks in $numbers; do shared $deep $ranks regular regular-$ranks $regular; done
    # a rank whose last face of the cut axis is the domain's has a plane of 8 bytes per face more
    continued_by_others one parts $((8 * cells)) $((8 * cells)) 0.004
    ;;
storage_heightfield) # the same of rows of columns, with rain over a part of them, and of varied depth where they pull their neighbours
    cat >lake.toml <<-END
	solver = "heightfield"
	dim = 3
	grid = { cells = [512, 1, 1024], size = [51.2, 2.0, 102.4], origin = [0.0, -1.0, 0.0] }
	time = { end = 0.06, max_dt = 0.01 }
	terrain = { kind = "formula", height = "-1 + 0.05*sin(0.3*x)" }
	initial.surface = "0.1*exp(-((x-5)^2 + (z-45)^2))"
	effects.gravity.g = [0.0, -9.81, 0.0]
	output = { every = 1.0, fields = ["depth"] }
	END
    rain='--set effects.rain={rate=0.01,over=[1.0,2.0,30.0,90.0]}'
    for model in shallow_water columns; do
        lake=(lake.toml --quiet --threads 1 --set scheme.model=$model)
        [ $model = columns ] || lake+=($rain)
        ends 0 "$weir" run "${lake[@]}" --checkpoint-every 1000 --out $model
        one=$(holds $model)
        for ranks in $numbers; do
            ends 0 over $ranks "$weir" run "${lake[@]}" --checkpoint-every 1000 --out $model-$ranks
            alike $model $model-$ranks
            holds_own $model-$ranks
            ends 0 over $ranks "$weir" run lake.toml --quiet --threads 1 --set scheme.model=$model --out tiny-$ranks --set grid.cells=[8,1,64]
            for rank in $(seq 0 $((ranks - 1))); do
                # Two ghost rows on both sides, and one. Whole are what a stage says of each row, 4 numbers, and its scratch of less than 40 rows.
                held=$(told $model-$ranks solver_bytes $rank) rows=$((1024 / ranks))
                at_most "$held" $((one * (rows + 5) / 1024 + 4 * 8 * 1024 + 40 * 8 * (512 + 24))) "$model, rank $rank of $ranks"
                # As the system sees it, at any time of the run, beyond what a run of a few columns takes: that, the last good state and a
                # checkpoint beside it (4 numbers a column, each), a page at both ends of less than 32 arrays; and of a frame the own part
                # of its array, a number a column, and what the first rank puts into the file at once.
                more_held=$(peak_beyond tiny-$ranks $model-$ranks $rank)
                at_most $more_held $((held + (2 * 4 + 1) * 8 * 512 * rows + 32 * 2 * 4096 + handed + 2 * huge_page)) "$model peak, rank $rank of $ranks"
            done
        done
        continued_by_others $model $model 0 0 0.09
    done
    ;;
storage_waves) # the same of a sea: rows of the sheet, and its waves by columns of wavenumbers; with water below it, layers of rows; of a basin
    cat >sea.toml <<-END
	solver = "waves"
	dim = 3
	grid = { cells = [512, 1, 512], size = [512.0, 40.0, 512.0], origin = [0.0, -20.0, 0.0] }
	time = { end = 0.3, dt = 0.1 }
	fluid.density = 1025.0
	waves = { model = "spectrum", spectrum = { kind = "pierson_moskowitz", wind = 8.0 }, heading = 0.4, depth = 60.0 }
	effects.gravity.g = [0.0, -9.81, 0.0]
	output = { every = 1.0, fields = ["velocity"] }
	END
    heap='--set waves={model="basin"} --set liquid=[{shape="box",min=[0.0,-20.0,0.0],max=[512.0,0.0,512.0]},{shape="sphere",centre=[200.0,0.0,300.0],radius=15.0}]'
    for sea in "choppy --set waves.choppiness=0.8" "deep --set grid.cells=[256,8,512]" "basin $heap --set grid.cells=[256,8,512]"; do
        read -r name more <<<"$sea"
        cells=$([ $name = choppy ] && echo 512 || echo $((256 * 8))) points=$([ $name = choppy ] && echo 512 || echo 256) # of a plane
        ends 0 "$weir" run sea.toml $more --checkpoint-every 1000 --quiet --threads 1 --out $name
        one=$(holds $name)
        for ranks in $numbers; do
            ends 0 over $ranks "$weir" run sea.toml $more --checkpoint-every 1000 --quiet --threads 1 --out $name-$ranks
            alike $name $name-$ranks
            holds_own $name-$ranks
            ends 0 over $ranks "$weir" run sea.toml --quiet --threads 1 --out tiny-$ranks --set grid.cells=[64,1,64]
            for rank in $(seq 0 $((ranks - 1))); do
                # One ghost row on both sides, and one. Half the waves with 5 complex and 2 real numbers each; of their columns, one more than of the
                # rows, the last rank has one more than its share. What a transposition brings and takes: half the waves of this rank; of a
                # basin all, in real numbers.
                held=$(told $name-$ranks solver_bytes $rank) rows=$((512 / ranks))
                waves=$(((points / 2 + 1) * 512)) more_columns=$(((5 * 16 + 2 * 8) * 512))
                [ $name != basin ] || waves=$((points * 512 / 2)) more_columns=0
                at_most "$held" $((one * (rows + 3) / 512 + more_columns + 2 * 16 * (waves / ranks + 512))) "$name, rank $rank of $ranks"
                # As the system sees it, at any time of the run: that, a page at both ends of less than 32 arrays, two pages of 2 MiB, which
                # the system may give for smaller ones; and of a frame the own part of its largest array, 3 numbers a cell or 4 corners between points, and what the first rank puts into the file at once.
                more_held=$(peak_beyond tiny-$ranks $name-$ranks $rank)
                array=$((3 * cells > 4 * points ? 3 * cells : 4 * points))
                at_most $more_held $((held + 8 * array * rows + 32 * 2 * 4096 + handed + 2 * huge_page)) "$name peak, rank $rank of $ranks"
            done
        done
    done
    ;;
storage_surface) # of the liquid's surface too each rank holds its part: its own planes and particles, those that it reads beside them, its mesh
    # extra RANKS RANK FOLDER: what the surface adds to a rank's peak, beyond what it adds to that of a few cells (VTK's filters themselves)
    extra() { echo $(($(peak_beyond "$3-plain-$1" "$3-$1" "$2") - $(peak_beyond "$3-tiny-plain-$1" "$3-tiny-$1" "$2"))); }
    # made NAME SURFACE "TINY" SCENE: with a surface and without, in a tank and in a part of it
    made() {
        local name=$1 surface=$2 tiny=$3 ranks
        shift 3
        ends 0 "$weir" run "$@" --quiet --threads 1 --out $name --set "output.surface={method=\"$surface\"}"
        for ranks in $numbers; do
            ends 0 over $ranks "$weir" run "$@" --quiet --threads 1 --out $name-$ranks --set "output.surface={method=\"$surface\"}"
            alike $name $name-$ranks
            ends 0 over $ranks "$weir" run "$@" --quiet --threads 1 --out $name-plain-$ranks
            ends 0 over $ranks "$weir" run "$@" $tiny --quiet --threads 1 --out $name-tiny-$ranks --set "output.surface={method=\"$surface\"}"
            ends 0 over $ranks "$weir" run "$@" $tiny --quiet --threads 1 --out $name-tiny-plain-$ranks
        done
    }
    cat >column.toml <<-END
	solver = "pbf"
	dim = 3
	grid = { cells = [24, 24, 520], size = [0.24, 0.24, 5.2] }
	time = { end = 0.004, dt = 2e-3 }
	liquid = [ { shape = "box", min = [0.0, 0.0, 0.0], max = [0.24, 0.12, 5.12] } ]
	output = { every = 1.0 }
	END
    made column density '--set grid.cells=[24,24,40] --set grid.size=[0.24,0.24,0.4] --set liquid=[{shape="box",min=[0.0,0.0,0.0],max=[0.24,0.12,0.3]}]' column.toml
    layer=$((24 * 12)) # of 512
    for ranks in $numbers; do
        for rank in $(seq 0 $((ranks - 1))); do
            # A particle: 28 bytes, 48 given to those who read it and 48 as it comes; and then 24 of its velocity, 28 with images and room for
            # as many, 32 sorted, and 70 of samples and mesh, which is more. Cuts are at multiples of 8 planes, and less than 12 layers
            # beyond them are read. The first rank has pieces of the file too; the system may give
            # pages of 2 MiB.
            at_most "$(extra $ranks $rank column)" $((190 * layer * (512 / ranks + 4 + 2 * 12) + 2 * huge_page + (rank == 0 ? handed : 0))) "surface of particles, rank $rank of $ranks"
        done
    done
    cat >pool.toml <<-END
	solver = "mac_water"
	dim = 3
	grid = { cells = [32, 32, 256], size = [0.32, 0.32, 2.56] }
	time = { end = 0.002, max_dt = 0.001 }
	liquid = [ { shape = "box", min = [0.0, 0.0, 0.0], max = [0.32, 0.16, 2.56] } ]
	initial.velocity = { name = "random", speed = 0.1 }
	output = { every = 1.0, fields = ["pressure"] }
	END
    made pool level_set '--set grid.cells=[32,32,80] --set grid.size=[0.32,0.32,0.8]' pool.toml
    for ranks in $numbers; do holds_own pool-$ranks; done
    for ranks in $numbers; do
        for rank in $(seq 0 $((ranks - 1))); do
            # Samples, of which two ghost planes on both sides and one; and less than 120 points and 240 triangles a plane: 150 and 60 bytes each.
            # The level set, the velocity and the markers of all would be 32 bytes per cell and 192 a cell of liquid. Pages as above.
            at_most "$(extra $ranks $rank pool)" $(((4 * 34 * 34 + 120 * 150 + 240 * 60) * (256 / ranks + 5) + 2 * huge_page + (rank == 0 ? handed : 0))) "surface of a level set, rank $rank of $ranks"
        done
    done
    ;;
halo) # NaN in every stale ghost plane, at each halo exchange
    poisoned 3 1 "$flat"
    poisoned 2 1 "$deep"
    poisoned 3 1 "$water"
    poisoned 3 1 "$water" "${frictionless[@]}"
    for case in "" "--set grid.cells=[28,40,26]" "$viscous" "$viscous --set scheme.transfer=apic $water_ring $even" "--set scheme.transfer=apic $water_ring $even" "--set time.cfl=2 $water_ring" "--set scheme.transfer=grid"; do
        poisoned 3 1 "$water_deep" $case
    done
    for case in "$shallow" "$columns" "$sea" "$trains" "$below" "$below $basin" \
        "$tall_deep" "$tall_deep --set solids=[] $water_ring --set time.cfl=2" "$tall_deep $fast" "$tall" \
        "$drops" "$drops_deep" "$drops $sph" "$drops_deep $sph" "$drops $sph --set scheme.density=summation"; do
        poisoned 3 1 $case
    done
    ;;
petsc) # shares its rows: within the tolerance what multigrid finds in one process, whatever the number of ranks
    built=0
    "$weir" run "$flat" --explain --set scheme.poisson.method=petsc_icc >log 2>&1 || built=$?
    ! grep -q "built without it" log || { echo "skipped: built without PETSc (Debian: apt-get install libpetsc-real-dev)"; exit 77; }
    [ "$built" -eq 0 ] || fail "PETSc's method was refused in one process"
    if [ $# -gt 4 ]; then
        ends 2 over 2 "$weir" run "$flat" --quiet --out refused --set scheme.poisson.method=petsc_icc
        says "the ranks were started by an MPI other than the one that PETSc was built with"
        [ ! -e refused ] || fail "a refused run has written"
        exit 0
    fi
    # near ONE OTHER: all that their probes read, to 1e-6 of the largest of it. Each solve leaves 1e-11 of its right-hand side, times a
    # condition of some 1e4 for 150 cells across, a few times over.
    near() {
        paste -d, "$1"/probes/here.csv "$2"/probes/here.csv | awk -F, '
            /^[0-9]/ { rows++; for (i = 2; i <= NF / 2; i++) { a = $i; b = $(i + NF / 2); d = a > b ? a - b : b - a; if (d > worst) worst = d
                if (a < 0) a = -a; if (a > largest) largest = a } d = $1 - $(1 + NF / 2); if (d * d > 1e-18) other = 1 }
            END { printf "%d rows, differ by %g of %g\n", rows, worst, largest; exit !(rows > 2 && !other && largest > 0 && worst <= 1e-6 * largest) }' >log ||
            fail "$2 is not near $1"
    }
    first_iterations() { sed -n 2p "$1"/steps.csv | cut -d, -f8; }
    each() { # NAME SCENE [--set ...]
        local name=$1 method ranks
        shift
        ends 0 "$weir" run "$@" --quiet --threads 1 --out $name
        for method in gamg boomeramg icc; do
            for ranks in $([ "$size" = ci ] && echo 1 3 || echo 1 2 3); do
                ends 0 over $ranks "$weir" run "$@" --set scheme.poisson.method=petsc_$method --quiet --threads 1 --out $name-$method-$ranks
                near $name $name-$method-$ranks
            done
            grep -q '"replicated_work":\["pressure_matrix"' $name-$method-3/run.json || fail "run.json does not tell what is not shared"
        done
        # Blocks of rows that are factored alone know less of each other: so the rows were really shared.
        [ "$(first_iterations $name-icc-3)" -gt "$(first_iterations $name-icc-1)" ] || fail "three blocks took no more iterations than one"
    }
    exact="--set scheme.poisson.tolerance=1e-11 --set time.end=0.04 --set output.every=0.04"
    each open "$flat" $exact --set 'probes=[{name="here",kind="point",field="velocity",at=[0.37,0.4]}]'
    each closed "$flat" $exact --set 'probes=[{name="here",kind="point",field="velocity",at=[0.37,0.4]}]' --set 'sides={y_max={kind="wall"}}'
    each water "$water" $exact --set 'probes=[{name="here",kind="point",field="velocity",at=[0.2,0.3]}]'
    each water_3d "$water_deep" $exact --set 'probes=[{name="here",kind="point",field="velocity",at=[0.1,0.1,0.1]}]' --set time.end=0.02
    ;;
ends)
    # one alone: its scene is another, as on a machine with another disk. It waits ten seconds for the first, beside what follows.
    over 1 "$weir" run "$flat" --quiet --out alone : -n 1 "$weir" run "$flat" --quiet --out alone --set grid.cell=2 </dev/null >apart.log 2>&1 &
    alone=$!
    in_two_parts 0.08 0.12 "$flat"
    # a checkpoint that is none, or of another scene: the words of one process, once, and its exit code
    refuses_to_continue() { # WORDS SCENE.. of a restart of broken/
        local words=$1
        shift
        ends 2 "$weir" run "$@" --restart broken --quiet --out continued
        says "$words" && grep -v "^ *$" log >alone.log
        ends 2 over 3 "$weir" run "$@" --restart broken --quiet --out continued
        [ "$(grep -c -- "$words" log)" -eq 1 ] && grep -qxF "$(grep -- "$words" alone.log)" log || fail "other words than one process has: $words"
        [ ! -e continued ] || fail "a refused run has written"
    }
    mkdir broken
    size=$(stat -c %s parts/checkpoint.weir)
    for cut in 100 $((size / 2)) $((size - 1)); do
        head -c $cut parts/checkpoint.weir >broken/checkpoint.weir
        refuses_to_continue "truncated or altered (checksum differs)"
    done
    for at in 20 $((size / 2)) $((size - 20)); do # in the part of another rank each time
        cp parts/checkpoint.weir broken/checkpoint.weir
        printf '\377\376' | dd of=broken/checkpoint.weir bs=1 seek=$at conv=notrunc status=none
        refuses_to_continue "truncated or altered (checksum differs)"
    done
    head -c 10 parts/checkpoint.weir >broken/checkpoint.weir
    refuses_to_continue "not a checkpoint of this version"
    cp parts/checkpoint.weir broken/checkpoint.weir
    refuses_to_continue "the checkpoint does not match the scene" "$flat" --set grid.cells=[48,96]
    # refused by name, before anything is written, by all ranks
    refused() { # KEY SCENE [--set ...]
        local key=$1
        shift
        ends 2 over 3 "$weir" run "$@" --quiet --out refused
        says "$key"
        [ ! -e refused ] || fail "a refused run has written"
    }
    refused 'solver "closed_vessel" runs in one process only' "$scenes/../../../cases/closed_vessel/scene.toml"
    refused "effects.hand: interactive forcing is not supported in parallel (MPI); run in one process" "$tall" --set effects.hand={}
    refused "effects.hand: interactive forcing is not supported in parallel (MPI); run in one process" "$water" --set effects.hand={}
    refused "effects.hand: interactive forcing is not supported in parallel (MPI); run in one process" "$drops" --set effects.hand={}
    refused "effects.hand: interactive forcing is not supported in parallel (MPI); run in one process" "$gas" --set effects.hand={}
    refused "effects.viscosity: viscosity of two phases is not supported in parallel (MPI); run in one process" "$gas" --set effects.viscosity={}
    refused "scheme.backend: this backend is not supported in parallel (MPI); run in one process" "$drops" --set scheme.backend=reference
    refused "floats: floating objects are not supported in parallel (MPI); run in one process" "$columns" --set 'floats=[{size=[0.5,0.2,0.5],at=[1.0,0.3,1.0]}]'
    refused "effects.hand: interactive forcing is not supported in parallel (MPI); run in one process" "$shallow" --set effects.hand={}
    refused "effects.hand: interactive forcing is not supported in parallel (MPI); run in one process" "$line" --set effects.hand={}
    # what only some ranks see of their rows all say, in the words of one process
    refused "there is liquid over air at x = 50 m" "$below" --set 'waves={model="basin"}' \
        --set 'liquid=[{shape="box",min=[0.0,-10.0,0.0],max=[80.0,0.0,88.0]},{shape="box",min=[48.0,2.0,70.0],max=[60.0,3.0,88.0]}]'
    refused "terrain.height has no value at x = 0.05, z = 3.05" "$shallow" --set 'terrain.height="sqrt(3-z)"'
    refused "this water is above air at x = 2.95, z = 2.85" "$columns" --set initial={} --set 'liquid=[{shape="box",min=[2.0,0.5,2.8],max=[3.0,0.6,7.4]}]'
    ends 0 over 3 "$weir" run "$shallow" --checkpoint-every 1000 --quiet --out rows --set time.end=0.1
    cp rows/checkpoint.weir broken/checkpoint.weir
    refuses_to_continue "the checkpoint does not match the scene" "$shallow" --set grid.cells=[37,1,48]
    refused "at most 2" "$flat" --set grid.cells=[16,2]
    refused "planes of cells" "$flat" --set grid.cells=[16,2]
    refused "unknown key" "$flat" --set grid.cell=2
    ends 2 over 2 "$weir" list solvers
    says "only weir run works in parallel (MPI)"
    # a failure is one of all ranks
    ends 3 over 3 "$weir" run "$flat" --quiet --out failed --set scheme.poisson.method=cg --set scheme.poisson.max_iterations=1
    says "last good state"
    [ "$(grep -c "step 1" log)" -eq 1 ] || fail "said more than once"
    [ -e failed/last_good.weir ] || fail "no last good state"
    # what the first cannot write ends all ranks
    mkdir blocked && touch blocked/probes
    ends 2 over 3 "$weir" run "$flat" --quiet --out blocked
    says probes
    wait "$alone"
    [ $? -eq 2 ] && grep -q "rank 1 alone: .*unknown key" apart.log || { cat apart.log; fail "a rank with another scene than the first's"; }
    ;;
signals)
    long=(--set time.end=100 --set output.every=0.02 --set grid.cells=[48,64] --checkpoint-every 1)
    begin() { # OUT
        over 3 "$weir" run "$flat" "${long[@]}" --quiet --out "$1" >log 2>&1 &
        started=$!
        for _ in $(seq 600); do
            [ -e "$1/checkpoint.weir" ] && return
            sleep 0.1
        done
        fail "no checkpoint came"
    }
    ranks_of() { pgrep -f -- "run $flat .*--out $1"'$' | while read -r p; do [ "$(readlink "/proc/$p/exe")" = "$(realpath "$weir")" ] && echo "$p"; done; }
    # one of them is asked to end, and all do
    begin asked
    kill -USR1 "$(ranks_of asked | tail -n 1)"
    code=0
    wait "$started" || code=$?
    [ "$code" -eq 130 ] || fail "ended with $code after SIGUSR1"
    says "interrupted at step"
    # one is killed: all are gone, and what was written stays whole
    begin killed
    kill -9 "$(ranks_of killed | tail -n 1)"
    code=0 start=$SECONDS
    wait "$started" || code=$?
    [ "$code" -ne 0 ] || fail "a run with a killed rank has succeeded"
    # a killed rank ends the others at once; a busy machine may take some seconds
    [ $((SECONDS - start)) -le 20 ] && [ -z "$(ranks_of killed)" ] || fail "ranks live on beside a killed one"
    [ -e killed/frames/grid_000000.vti ] || fail "no frame was finished"
    # an uninterrupted run, three frames beyond the last of the two: a busy machine sends a signal late
    frames=$({ ls asked/frames; ls killed/frames; } | sed -n 's/grid_0*\([0-9]\{1,\}\)\.vti/\1/p' | sort -n | tail -n 1)
    end=$(awk "BEGIN { print 0.02 * ($frames + 3) }")
    ends 0 "$weir" run "$flat" "${long[@]}" --quiet --threads 1 --set time.end="$end" --out straight
    for frame in killed/frames/*.vti; do
        cmp "straight/${frame#killed/}" "$frame" >log || fail "a finished frame is another"
    done
    ends 0 over 2 "$weir" run --restart asked --quiet --set time.end="$end"
    files_differ straight asked 'checkpoint.weir*' >log || fail "an interrupted run is another"
    ends 0 "$weir" run --restart killed --threads 1 --quiet --set time.end="$end"
    files_differ straight killed 'checkpoint.weir*' >log || fail "the last checkpoint of a killed run continues otherwise"
    # a folder has one run at a time, of one process or of several
    begin taken
    ends 2 over 2 "$weir" run "$flat" --quiet --out taken
    says "taken: another run writes into this folder (process "
    ends 2 "$weir" run "$flat" --quiet --out taken
    kill -USR1 "$(ranks_of taken | tail -n 1)"
    wait "$started"
    ends 0 over 2 "$weir" run "$flat" --quiet --threads 1 --set time.end=0.01 --out taken
    ;;
busy)
    busy=()
    # beside busy processes ranks that wait for one another sleep: they work for about as long as one process, which polls for none
    for _ in 1 2; do (while :; do :; done) & busy+=($!); done
    trap 'kill "${busy[@]}"; rm -rf "$work"' EXIT
    seconds_of() { # COMMAND...: of the processor's time, of all its processes
        local TIMEFORMAT=%U
        { time ends 0 "$@" 2>&3; } 3>&2 2>seconds
        cat seconds
    }
    one=$(seconds_of "$weir" run "$flat" --set time.end=0.3 --quiet --threads 1 --out one)
    two=$(seconds_of over 2 "$weir" run "$flat" --set time.end=0.3 --quiet --threads 1 --out two)
    echo "$one s of one process, $two s of two ranks"
    alike one two
    grep -q '"busy_seconds":\[' two/run.json || fail "run.json does not tell how long others were busy"
    # each rank starts, and does what all do: 1 s. Polls of 2 ms each time they wait took 20 times as long as the work.
    awk "BEGIN { exit !($two < 5 * $one + 1) }" || fail "two ranks worked for $two s, and one process for $one s"
    ;;
esac
