/** The editor's top bar: where we are, what is saved, who is here, what can be done. */
import { Button } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { Box, CircleAlert, EyeOff, Play, Redo2, SlidersHorizontal, TriangleAlert, Undo2 } from "lucide-react";
import { useEffect, useRef, useState, useSyncExternalStore } from "react";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { api, ApiProblem } from "@/api/client";
import { useOnce } from "@/api/once";
import { keys } from "@/api/queries";
import type { Program, Rehearsal } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";
import { Crumb, TopBar } from "@/shell/TopBar";
import { Avatar } from "@/design/Avatar";
import { IconButton } from "@/design/IconButton";
import { FollowButton } from "../gestures/FollowButton";
import { Arm } from "./Arm";
import { focusMap } from "../state/focus";
import { SavedChip } from "./SavedChip";
import { VersionChip } from "./VersionChip";
import { useOpenProgram } from "../state/context";
import { useScreen } from "../state/screen";
import { say, select, showTab, useUi } from "../state/ui";
import { goBack } from "../state/undoing";
import classes from "./top.module.css";

export function EditorTop() {
  const { site, t } = useOpenProgram();
  return (
    <TopBar
      site={site.slug}
      crumbs={
        <>
          <Crumb to={`/sites/${site.slug}/programs`}>{site.name}</Crumb>
          <ProgramName />
        </>
      }
      chips={
        <>
          <SavedChip />
          <VersionChip />
        </>
      }
      presence={<People />}
      actions={<Actions />}
    >
      <span className={classes.undo} role="group" aria-label={t("history")}>
        <UndoButtons />
      </span>
    </TopBar>
  );
}

function ProgramName() {
  const { program, canEdit, t } = useOpenProgram();
  const queries = useQueryClient();
  const [name, setName] = useState(program.name);
  const takenBack = useRef(false);
  useEffect(() => setName(program.name), [program.name]);
  const rename = useMutation({
    mutationFn: (next: string) => api.patch<Program>(`/programs/${program.id}`, { name: next }),
    onSuccess: () => queries.invalidateQueries({ queryKey: keys.program(program.id) }),
    onError: (error) => {
      setName(program.name);
      say(error.message);
    },
  });
  if (!canEdit) return <Crumb>{program.name}</Crumb>;
  const keep = () => {
    const next = name.trim();
    if (next && next !== program.name && !takenBack.current) rename.mutate(next);
    else setName(program.name);
    takenBack.current = false;
  };
  return (
    <input
      className={classes.name}
      aria-label={t("program_name")}
      value={name}
      size={Math.max(8, name.length)}
      onChange={(event) => setName(event.target.value)}
      onBlur={keep}
      onKeyDown={(event) => {
        if ((event.key !== "Enter" && event.key !== "Escape") || event.nativeEvent.isComposing) return;
        event.preventDefault();
        takenBack.current = event.key === "Escape";
        focusMap();
      }}
    />
  );
}

function UndoButtons() {
  const { shared, t, canEdit } = useOpenProgram();
  const { undo } = shared;
  const undone = useSyncExternalStore(undo.subscribe, () => undo.next("undo"));
  const redone = useSyncExternalStore(undo.subscribe, () => undo.next("redo"));
  return (
    <>
      <IconButton label={t("undo")} disabled={!canEdit || !undone} onClick={() => goBack({ shared, t }, "undo")}>
        <Undo2 size={17} aria-hidden="true" />
      </IconButton>
      <IconButton label={t("redo")} disabled={!canEdit || !redone} onClick={() => goBack({ shared, t }, "redo")}>
        <Redo2 size={17} aria-hidden="true" />
      </IconButton>
    </>
  );
}

/** So many people have a picture; the others are named behind them. */
const MOST_SHOWN = 6;

export function People() {
  const { people, t, shared } = useOpenProgram();
  const rest = people
    .slice(MOST_SHOWN)
    .map(({ name }) => name)
    .join(", ");
  const { connection } = useSyncExternalStore(shared.subscribeSaving, shared.getSaving);
  return (
    <>
      {connection === "live" ? null : (
        <span className={classes.unseen} role="img" aria-label={t("people_unseen")} title={t("people_unseen")}>
          <EyeOff size={15} aria-hidden="true" />
        </span>
      )}
      {people
        .slice(0, MOST_SHOWN)
        .map((person) =>
          person.me ? (
            <Avatar
              key={person.client}
              name={person.name}
              initials={person.initials}
              colour={person.colour}
              live
              title={t("you", { name: person.name })}
            />
          ) : (
            <FollowButton key={person.client} person={person} />
          ),
        )}
      {rest ? (
        <Avatar
          name={rest}
          initials={`+${people.length - MOST_SHOWN}`}
          colour="#475067"
          title={t("people_more", { names: rest })}
        />
      ) : null}
    </>
  );
}

function Actions() {
  const { diagnostics, t, canRun } = useOpenProgram();
  const errors = diagnostics.filter((each) => each.severity === "error").length;
  return (
    <>
      <span className={classes.arm}>
        <Arm />
      </span>
      <Problems />
      <SimulateButton />
      <SimulateWith />
      <Button
        data-tour="run"
        leftSection={<Play size={16} aria-hidden="true" />}
        disabled={!canRun || errors > 0}
        title={errors > 0 ? t("run_blocked") : undefined}
        onClick={() => useUi.setState({ dialog: "run" })}
      >
        {t("run")}
      </Button>
    </>
  );
}

/** How much is wrong; a press goes to the first of it. */
function Problems() {
  const { diagnostics, t } = useOpenProgram();
  const errors = diagnostics.filter((each) => each.severity === "error");
  const warnings = diagnostics.length - errors.length;
  const toFirst = () => {
    showTab("problems");
    const first = errors[0] ?? diagnostics[0];
    if (first?.step) select([first.step]);
  };
  return (
    <>
      {errors.length > 0 ? (
        <button type="button" className={classes.problems} data-tone="error" onClick={toFirst}>
          <CircleAlert size={14} aria-hidden="true" />
          <span className={classes.words}>{t("errors", { count: errors.length })}</span>
          <span className={classes.figure} aria-hidden="true">
            {errors.length}
          </span>
        </button>
      ) : null}
      {warnings > 0 ? (
        <button type="button" className={classes.problems} data-tone="warn" onClick={toFirst}>
          <TriangleAlert size={14} aria-hidden="true" />
          <span className={classes.words}>{t("warnings", { count: warnings })}</span>
          <span className={classes.figure} aria-hidden="true">
            {warnings}
          </span>
        </button>
      ) : null}
    </>
  );
}

function SimulateWith() {
  const { canRun } = useOpenProgram();
  const { t } = useTranslation();
  return (
    <span className={classes.arm}>
      <IconButton
        label={t("commands.simulate_with.name")}
        disabled={!canRun}
        onClick={() => useUi.setState({ dialog: "rehearse" })}
      >
        <SlidersHorizontal size={16} aria-hidden="true" />
      </IconButton>
    </span>
  );
}

function SimulateButton() {
  const { t, program, shared, canRun } = useOpenProgram();
  const navigate = useNavigate();
  const begin = useOnce();
  const rehearse = useMutation({
    mutationFn: async () => {
      await shared.stored();
      return begin<Rehearsal>(`/programs/${program.id}/rehearsals`, {});
    },
    onSuccess: (rehearsal) => void navigate(`/programs/${program.id}/simulate/${rehearsal.id}`),
    onError: (error) => {
      const full = error instanceof ApiProblem && error.code === "too_many_rehearsals";
      // There people see what waits, and can cancel some of it.
      if (full) void navigate(`/programs/${program.id}/simulate`, { state: { refusal: error.detail } });
      else say(problemText(error, error.message));
    },
  });
  const { mutate, isPending } = rehearse;
  useEffect(() => {
    useScreen.setState({ simulate: canRun && !isPending ? () => mutate() : null });
    return () => useScreen.setState({ simulate: null });
  }, [canRun, isPending, mutate]);
  return (
    <Button
      variant="default"
      className={classes.sign}
      title={t("simulate")}
      leftSection={<Box size={16} aria-hidden="true" />}
      loading={rehearse.isPending}
      disabled={!canRun}
      onClick={() => rehearse.mutate()}
    >
      <span className={classes.words}>{t("simulate")}</span>
    </Button>
  );
}
