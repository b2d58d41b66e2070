/** What robots cannot come to on this floor and why, as a list; each finding has its number on the map. */
import { Button, Skeleton } from "@mantine/core";
import { CircleCheck, OctagonAlert, TriangleAlert } from "lucide-react";
import { useRef } from "react";
import { useTranslation } from "react-i18next";
import { useDevices, usePrograms } from "@/api/queries";
import type { FloorCheck, FloorFinding, SiteMap } from "@/api/types";
import { Chip } from "@/design/Chip";
import { NumberField } from "@/design/NumberField";
import { problemText } from "@/shell/LoadProblem";
import places from "../places/places.module.css";
import styles from "./check.module.css";
import { findingWords, isError, keyOf, metres } from "./findingWords";
import { Remedies } from "./Remedies";
import type { FloorCheckView } from "./useFloorCheckView";

interface FloorCheckPanelProps {
  slug: string;
  map: SiteMap;
  view: FloorCheckView;
  /** Changes the zones of the map, this one first; null for who may not. */
  editZone: ((zone: string | null) => void) | null;
}

export function FloorCheckPanel(props: FloorCheckPanelProps) {
  const { view } = props;
  const { t } = useTranslation();
  const { check, error } = view;
  const head = useRef<HTMLHeadingElement>(null);
  return (
    <section className={styles.panel} aria-labelledby="floor-check" aria-busy={view.isChecking}>
      <div className={styles.head}>
        <h2 id="floor-check" ref={head} tabIndex={-1}>
          {t("floorCheck.floorCheck")}
        </h2>
        {check && view.isChecking ? (
          <span className={styles.checking} aria-hidden="true">
            {t("floorCheck.checking")}
          </span>
        ) : null}
        {check ? <Counts findings={check.findings} /> : null}
      </div>
      <NumberField
        className={styles.other}
        label={t("floorCheck.other")}
        description={t("floorCheck.otherHelp")}
        placeholder={check ? metres(check.width_m) : ""}
        value={view.width}
        min={0.1}
        max={3}
        step={0.05}
        decimalScale={2}
        suffix=" m"
        onChange={view.setWidth}
        error={view.isOdd ? t("floorCheck.odd") : null}
      />
      {error ? (
        <div role="alert" className={styles.failed}>
          <p>{problemText(error, t("floorCheck.failed"))}</p>
          <Button variant="default" size="xs" onClick={view.again}>
            {t("shell.problem.again")}
          </Button>
        </div>
      ) : null}
      {!check && !error ? <Skeleton height={72} /> : null}
      {check ? <Found {...props} check={check} leave={() => head.current?.focus()} /> : null}
    </section>
  );
}

function Counts({ findings }: { findings: readonly FloorFinding[] }) {
  const { t } = useTranslation();
  const errors = findings.filter(isError).length;
  const warnings = findings.length - errors;
  return (
    <span className={styles.counts}>
      {errors > 0 ? <Chip tone="error">{t("floorCheck.errors", { count: errors })}</Chip> : null}
      {warnings > 0 ? <Chip tone="warn">{t("floorCheck.warnings", { count: warnings })}</Chip> : null}
    </span>
  );
}

interface FoundProps extends FloorCheckPanelProps {
  check: FloorCheck;
  /** Goes on at the head of the list: a finding that is mended leaves it. */
  leave: () => void;
}

function Found({ slug, map, check, view, editZone, leave }: FoundProps) {
  const { t } = useTranslation();
  const devices = useDevices(slug).data ?? [];
  const names = new Map([...devices, ...map.places, ...map.zones].map(({ id, name }) => [id, name]));
  const nameOf = (id: string) => names.get(id) ?? id;
  const width = metres(check.width_m);
  return (
    <>
      <p className={places.quiet}>
        {check.robot
          ? t("floorCheck.forRobot", { width, robot: nameOf(check.robot) })
          : t("floorCheck.forWidth", { width })}
      </p>
      <ol className={styles.findings} aria-label={t("floorCheck.findings")}>
        {check.findings.map((finding, index) => (
          <li key={keyOf(finding)}>
            <Row
              slug={slug}
              finding={finding}
              number={index + 1}
              isExplained={finding.code === "off_lattice" && check.findings[index - 1]?.code === finding.code}
              nameOf={nameOf}
              view={view}
            />
            {editZone && view.chosen === finding ? (
              <Remedies
                slug={slug}
                map={map}
                finding={finding}
                nameOf={nameOf}
                view={view}
                editZone={editZone}
                leave={leave}
              />
            ) : null}
          </li>
        ))}
      </ol>
      <ul className={styles.sound}>
        {(["machines", "places"] as const)
          .filter((kind) => check[kind].of > 0 && check[kind].reached === check[kind].of)
          .map((kind) => (
            <li key={kind}>
              <CircleCheck size={16} aria-hidden="true" />
              {t(`floorCheck.all.${kind}`, { count: check[kind].of })}
            </li>
          ))}
      </ul>
    </>
  );
}

interface RowProps {
  slug: string;
  finding: FloorFinding;
  number: number;
  /** The finding before says the same and has explained it. */
  isExplained: boolean;
  nameOf: (id: string) => string;
  view: FloorCheckView;
}

function Row({ slug, finding, number, isExplained, nameOf, view }: RowProps) {
  const { t } = useTranslation();
  const { title, text } = findingWords(finding, nameOf, t);
  const Sign = isError(finding) ? OctagonAlert : TriangleAlert;
  const programs = usePrograms(slug).data?.filter((each) => [...each.places, ...each.devices].includes(finding.target));
  return (
    <button
      type="button"
      className={styles.finding}
      data-grave={isError(finding)}
      aria-pressed={view.chosen === finding}
      onClick={() => view.choose(finding)}
    >
      <span className={styles.number}>{number}</span>
      <span className={styles.words}>
        <strong>{title}</strong>
        {isExplained ? null : <span>{text}</span>}
        {programs && programs.length > 0 ? (
          <span>{t("floorCheck.stops", { names: programs.map(({ name }) => name).join(", ") })}</span>
        ) : null}
      </span>
      <Sign size={16} aria-label={t(isError(finding) ? "floorCheck.error" : "floorCheck.warning")} />
    </button>
  );
}
