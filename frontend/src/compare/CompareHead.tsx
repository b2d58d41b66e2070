/** Over the map: both sides with name, author and time, which of them is shown, and all of the old one back. */
import { Button, Menu, SegmentedControl } from "@mantine/core";
import { ArrowDownUp, ArrowRight, ChevronDown, RotateCcw } from "lucide-react";
import type { ReactNode } from "react";
import { useTranslation } from "react-i18next";
import type { Comparison, RunSummary, Version } from "@/api/types";
import { Avatar } from "@/design/Avatar";
import { IconButton } from "@/design/IconButton";
import { formatMoment } from "@/i18n/format";
import styles from "./compare.module.css";
import type { Shown } from "./marks";
import { DRAFT, otherSide, otherSideOf, type Relative, runSide, versionOfSide, versionTitle } from "./sides";
import type { Restore } from "./useRestore";

interface HeadProps {
  versions: readonly Version[];
  runs: readonly RunSummary[];
  relatives: readonly Relative[];
  sides: { old: string; new: string };
  choose: (next: { old: string; new: string }) => void;
  shown: Shown;
  setShown: (shown: Shown) => void;
  comparison: Comparison | undefined;
  restore: Restore | null;
  /** What stands below both sides. */
  children?: ReactNode;
}

export function CompareHead(props: HeadProps) {
  const { versions, runs, relatives, sides, choose, shown, setShown, comparison, restore } = props;
  const { t } = useTranslation();
  const number = versionOfSide(sides.old, runs);
  return (
    <section className={styles.head} aria-label={t("compare.sides")}>
      <SidePicker
        which="old"
        {...{ versions, runs, relatives }}
        shown={comparison?.old.version}
        side={sides.old}
        onChoose={(old) => choose({ ...sides, old })}
      />
      <ArrowRight size={18} className={styles.arrow} aria-hidden="true" />
      <SidePicker
        which="new"
        {...{ versions, runs, relatives }}
        shown={comparison?.new.version}
        side={sides.new}
        onChoose={(next) => choose({ ...sides, new: next })}
      />
      <IconButton label={t("compare.swap")} onClick={() => choose({ old: sides.new, new: sides.old })}>
        <ArrowDownUp size={17} aria-hidden="true" />
      </IconButton>
      <span className={styles.spring} />
      <SegmentedControl
        size="xs"
        aria-label={t("compare.shown")}
        value={shown}
        onChange={(value) => setShown(value)}
        data={(["old", "both", "new"] as const).map((value) => ({ value, label: t(`compare.show.${value}`) }))}
      />
      {restore && number ? (
        <Button
          variant="default"
          size="xs"
          leftSection={<RotateCcw size={14} aria-hidden="true" />}
          loading={restore.busy}
          onClick={() => restore.ask({ what: "all" })}
        >
          {t("compare.restore_all", { number })}
        </Button>
      ) : null}
      {props.children}
    </section>
  );
}

interface PickerProps {
  which: "old" | "new";
  side: string;
  /** The version that is on this side, as the comparison has it. */
  shown: Version | null | undefined;
  versions: readonly Version[];
  runs: readonly RunSummary[];
  relatives: readonly Relative[];
  onChoose: (side: string) => void;
}

function SidePicker({ which, side, shown, versions, runs, relatives, onChoose }: PickerProps) {
  const { t } = useTranslation();
  const run = runs.find((each) => runSide(each.id) === side);
  const number = versionOfSide(side, runs);
  const other = otherSide(side);
  // One that is older than the listed ones is told by what is compared.
  const listed = versions.find((each) => String(each.number) === number);
  const told = other || String(shown?.number) === number ? (shown ?? undefined) : undefined;
  const version = listed ?? told;
  const numbered = t("compare.version", { number: number ?? side });
  const named = version ? versionTitle(version, (key) => String(t(key))) : numbered;
  const isDraft = side === DRAFT;
  const own = isDraft ? t("compare.drawn_now") : named;
  const relative = relatives.find((each) => each.id === other?.program);
  const title = other ? (relative?.name ?? t("compare.other")) : own;
  const place = relative?.site ?? t("compare.other");
  const short = isDraft ? t("compare.draft") : run ? t("compare.run", { number: run.number }) : shortOf(side, place);
  return (
    <div className={styles.side}>
      <Menu position="bottom-start" width={320} shadow="md">
        <Menu.Target>
          <button
            type="button"
            className={styles.picker}
            data-which={which}
            aria-label={t(`compare.pick.${which}`, { side: short })}
          >
            {short}
            <ChevronDown size={14} aria-hidden="true" />
          </button>
        </Menu.Target>
        <Menu.Dropdown className={styles.menu}>
          <Choices {...{ versions, runs, relatives, onChoose }} />
        </Menu.Dropdown>
      </Menu>
      <SideWords title={title} version={isDraft ? undefined : version} />
    </div>
  );
}

/** `v7`, at another site `shed: v7`. */
function shortOf(side: string, place: string): string {
  const other = otherSide(side);
  if (!other) return `v${side}`;
  return `${place}: ${other.version === DRAFT ? DRAFT : `v${other.version}`}`;
}

/** How many runs the menu names; older ones are reached from their versions in the history. */
const MOST_RUNS = 12;

function Choices({ versions, runs, relatives, onChoose }: Omit<PickerProps, "which" | "side" | "shown">) {
  const { t } = useTranslation();
  const ran = runs.filter((each) => each.version).slice(0, MOST_RUNS);
  return (
    <>
      <Menu.Item onClick={() => onChoose(DRAFT)}>{t("compare.drawn_now")}</Menu.Item>
      <Menu.Divider />
      {versions.map((each) => (
        <Menu.Item
          key={each.number}
          onClick={() => onChoose(String(each.number))}
          rightSection={<small>{formatMoment(each.created_at)}</small>}
        >
          <b>{`v${each.number}`}</b> {versionTitle(each, (key) => String(t(key)))}
        </Menu.Item>
      ))}
      {ran.length > 0 ? <Menu.Label>{t("compare.runs")}</Menu.Label> : null}
      {ran.map((each) => (
        <Menu.Item key={each.id} onClick={() => onChoose(runSide(each.id))}>
          {t("compare.ran", { run: each.number, number: each.version })}
        </Menu.Item>
      ))}
      {relatives.length > 0 ? <Menu.Label>{t("compare.elsewhere")}</Menu.Label> : null}
      {relatives.flatMap(({ id, name, site, newest }) =>
        ([DRAFT, ...(newest > 0 ? [newest] : [])] as const).map((version) => (
          <Menu.Item key={`${id} ${version}`} onClick={() => onChoose(otherSideOf(id, version))}>
            {t(version === DRAFT ? "compare.there_draft" : "compare.there", { site, name, number: version })}
          </Menu.Item>
        )),
      )}
    </>
  );
}

function SideWords({ title, version }: { title: string; version: Version | undefined }) {
  const { t } = useTranslation();
  const by = version?.author?.name ?? "";
  const at = version ? formatMoment(version.created_at) : t("compare.with_all");
  return (
    <>
      <span className={styles.sideWords}>
        <b title={title}>{title}</b>
        <small>{by ? `${by}, ${at}` : at}</small>
      </span>
      {version?.author ? (
        <Avatar name={version.author.name} initials={version.author.initials} size={24} title={version.author.name} />
      ) : null}
    </>
  );
}
