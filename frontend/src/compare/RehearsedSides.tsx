/** Both sides rehearsed one beside the other: what becomes of the time, the robots and the waits. */
import { Button } from "@mantine/core";
import { FlaskConical } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useMutation } from "@tanstack/react-query";
import { useOnce } from "@/api/once";
import { mayOperate } from "@/api/roles";
import type { Rehearsal, Role } from "@/api/types";
import { clock } from "@/design/clock";
import { formatNumber } from "@/i18n/format";
import { reasonWords } from "@/i18n/reasons";
import { isOver } from "@/live/messages";
import { useFreshRehearsal } from "@/live/rehearsal";
import { problemText } from "@/shell/LoadProblem";
import styles from "./compare.module.css";
import { figuresOf, usedByOne, type Figures } from "./figures";
import { DRAFT } from "./sides";

type Sides = readonly [string, string];

interface RehearsedProps {
  program: string;
  role: Role;
  /** The sides as versions' numbers or `draft`. */
  asked: Sides;
  nameOf: (device: string) => string;
}

/** Starts a rehearsal of each side; only one where both are the same. */
function useBoth(program: string, asked: Sides) {
  const begin = [useOnce(), useOnce()] as const;
  return useMutation({
    mutationFn: () =>
      Promise.all(
        asked.map((side, at) => {
          const version = side === DRAFT ? null : Number(side);
          return begin[at === 0 ? 0 : 1]<{ id: string }>(`/programs/${program}/rehearsals`, { version });
        }),
      ),
  });
}

export function RehearsedSides({ program, role, asked, nameOf }: RehearsedProps) {
  const { t } = useTranslation();
  const both = useBoth(program, asked);
  const [old, next] = [useFreshRehearsal(both.data?.[0]?.id).data, useFreshRehearsal(both.data?.[1]?.id).data];
  if (!mayOperate(role) || asked[0] === asked[1] || asked.includes("0")) return null;
  const waits =
    both.isPending || (both.data !== undefined && ![old, next].every((each) => each && isOver(each.status)));
  return (
    <div className={styles.rehearsed}>
      {old && next && !waits ? <Table {...{ program, old, next, nameOf }} /> : null}
      <div className={styles.verdict}>
        {waits ? <Progress sides={[old, next]} /> : null}
        {both.error ? <small role="alert">{problemText(both.error, t("shell.problem.screen"))}</small> : null}
        <Button
          size="xs"
          variant="default"
          leftSection={<FlaskConical size={14} aria-hidden="true" />}
          disabled={waits}
          onClick={() => both.mutate()}
        >
          {t(both.data ? "compare.rehearsed.again" : "compare.rehearsed.start")}
        </Button>
      </div>
    </div>
  );
}

function Progress({ sides }: { sides: readonly (Rehearsal | undefined)[] }) {
  const { t } = useTranslation();
  const share = sides.reduce((sum, each) => sum + (each ? (isOver(each.status) ? 1 : each.progress) : 0), 0) / 2;
  return (
    <label className={styles.progress}>
      <small>{t("compare.rehearsed.under_way")}</small>
      <progress value={share} max={1} />
    </label>
  );
}

interface TableProps {
  program: string;
  old: Rehearsal;
  next: Rehearsal;
  nameOf: (device: string) => string;
}

function Table({ program, old, next, nameOf }: TableProps) {
  const { t } = useTranslation();
  const columns = columnsOf(old, next, nameOf, t);
  return (
    <div className={styles.figures}>
      <table>
        <caption className="visually-hidden">{t("compare.rehearsed.title")}</caption>
        <thead>
          <tr>
            <td />
            {columns.map(({ name }) => (
              <th key={name} scope="col">
                {t(`compare.rehearsed.${name}`)}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {[old, next].map((each, at) => (
            <tr key={at}>
              <th scope="row">
                <Link to={`/programs/${program}/simulate/${each.id}`}>
                  {t(at === 0 ? "compare.show.old" : "compare.show.new")}
                </Link>
              </th>
              {columns.map(({ name, told }) => (
                <td key={name} data-differs={told[0] !== told[1] || undefined}>
                  {told[at]}
                </td>
              ))}
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

type Words = (key: string, values?: Record<string, unknown>) => string;

interface Column {
  name: string;
  /** Of the old side and of the new one. */
  told: readonly [string, string];
}

/** What is told of both: how they ended, and where both have a result, its figures. */
function columnsOf(old: Rehearsal, next: Rehearsal, nameOf: (id: string) => string, t: Words): readonly Column[] {
  const end: Column = { name: "end", told: [endOf(old, t), endOf(next, t)] };
  if (!old.result || !next.result) return [end];
  const [before, after] = [figuresOf(old.result), figuresOf(next.result)];
  const column = (name: string, told: (figures: Figures) => string): Column => ({
    name,
    told: [told(before), told(after)],
  });
  const used = usedByOne(old.result, next.result);
  const names = (ids: readonly string[]) => ids.map(nameOf).join(", ") || "–";
  return [
    end,
    column("time", (each) => clock(each.duration_s)),
    column("steps", (each) => String(each.steps)),
    column("drives", (each) =>
      t("compare.rehearsed.driven", { count: each.robots, metres: formatNumber(each.distance_m, 1) }),
    ),
    column("waits", (each) => t("compare.rehearsed.waited", { count: each.waits, seconds: Math.round(each.waited_s) })),
    column("encounters", (each) => String(each.encounters)),
    ...(used.old.length + used.new.length > 0
      ? [{ name: "used", told: [names(used.old), names(used.new)] as const }]
      : []),
  ];
}

function endOf({ result, cause, reason }: Rehearsal, t: Words): string {
  if (!result) return reasonWords(cause, reason) || t("compare.rehearsed.not_done");
  return result.ok
    ? t("simulation.finishes")
    : t("simulation.stopsWithErrors", { count: Math.max(1, result.errors.length) });
}
