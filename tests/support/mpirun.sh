# over N [VARIABLE=VALUE ...] PROGRAM [ARGUMENT ...]: a program over N ranks, as it can be started where tests run: as root in a container,
# on fewer processors than there are ranks. By $MPIRUN where it is set. Where $FORKED is set, the program is weir, and forks its ranks itself.
# To be sourced.
over() {
    local ranks=$1 switches=()
    shift
    if [ -n "${FORKED:-}" ]; then
        env WEIR_FORKED_RANKS="$ranks" "$@"
        return
    fi
    if "${MPIRUN:-mpirun}" --version 2>/dev/null | grep -q "Open MPI"; then
        switches=(--allow-run-as-root --oversubscribe --bind-to none --mca btl_vader_single_copy_mechanism none)
    fi
    "${MPIRUN:-mpirun}" "${switches[@]}" -n "$ranks" env "$@"
}
