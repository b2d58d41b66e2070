/** One version: its picture, its name, who drew it, when, which runs used it, and what can be done with it. */
import { Button, Menu } from "@mantine/core";
import { Copy, Ellipsis, FileCode, FileJson, GitCompareArrows, Pencil, Play } from "lucide-react";
import { useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useVersion } from "@/api/queries";
import { mayOperate } from "@/api/roles";
import type { Program, Site, Version, VersionRuns, VersionTests } from "@/api/types";
import { compareAddress, DRAFT, versionTitle } from "@/compare/sides";
import { Avatar } from "@/design/Avatar";
import { IconButton } from "@/design/IconButton";
import { StatusBadge } from "@/design/StatusBadge";
import { formatMoment } from "@/i18n/format";
import { factOfTests } from "@/shell/review/versionTests";
import { StepsPicture } from "../library/FunctionPicture";
import { mayEdit } from "../programs/NewProgram";
import { statusOfRun } from "../runs/runStatus";
import { CopyVersion } from "./CopyVersion";
import styles from "./history.module.css";
import { NameVersion } from "./NameVersion";
import { RunVersion } from "./RunVersion";

interface RowProps {
  version: Version;
  /** The number of the version before; null for the first. */
  before: number | null;
  /** The runs that used it; null where none did, undefined while nobody knows. */
  used: VersionRuns | null | undefined;
  /** How its tests came out, if they were carried out on it. */
  tests: VersionTests | undefined;
  program: Program;
  site: Site;
}

export function VersionRow(props: RowProps) {
  const { version, before, program } = props;
  const { t } = useTranslation();
  const drew = version.authors.map((each) => each.name).join(", ");
  return (
    <li className={styles.version}>
      <Thumbnail {...props} />
      <div className={styles.about}>
        <h2>
          <b>{`v${version.number}`}</b> {versionTitle(version, (key) => String(t(key)))}
        </h2>
        {version.message ? <p>{version.message}</p> : null}
        <p className={styles.people}>
          {version.author ? <Avatar name={version.author.name} initials={version.author.initials} size={20} /> : null}
          {[version.author?.name, formatMoment(version.created_at)].filter(Boolean).join(", ")}
          {drew && drew !== version.author?.name ? <small>{t("history.drew", { people: drew })}</small> : null}
        </p>
        <Tests tests={props.tests} />
        <Runs used={props.used} />
      </div>
      <div className={styles.does}>
        <Button
          variant="default"
          component={Link}
          leftSection={<GitCompareArrows size={15} aria-hidden="true" />}
          to={compareAddress(program.id, String(version.number), DRAFT)}
        >
          {t("history.compare_draft")}
        </Button>
        {before === null ? null : (
          <Link className={styles.link} to={compareAddress(program.id, String(before), String(version.number))}>
            {t("history.compare_before", { number: before })}
          </Link>
        )}
      </div>
      <More {...props} />
    </li>
  );
}

/** The program as it was; fetched when the row comes into sight. */
function Thumbnail({ version, program, site }: RowProps) {
  const { t } = useTranslation();
  const [element, seen] = useSeen<HTMLDivElement>();
  const whole = useVersion(program.id, version.number, seen).data;
  return (
    <div ref={element} className={styles.thumbnail}>
      {whole ? (
        <StepsPicture
          slug={site.slug}
          drawn={whole.document}
          label={t("history.picture", { number: version.number })}
          whole
        />
      ) : null}
    </div>
  );
}

function useSeen<T extends Element>() {
  const element = useRef<T>(null);
  const [seen, setSeen] = useState(false);
  useEffect(() => {
    if (!element.current || seen) return;
    const watch = new IntersectionObserver((entries) => {
      if (entries.some((entry) => entry.isIntersecting)) setSeen(true);
    });
    watch.observe(element.current);
    return () => watch.disconnect();
  }, [seen]);
  return [element, seen] as const;
}

function Tests({ tests }: Pick<RowProps, "tests">) {
  const { t } = useTranslation();
  const fact = factOfTests(tests, t);
  if (!fact) return null;
  const status = fact.tone === "done" ? "done" : fact.tone === "error" ? "error" : "waiting";
  return (
    <p className={styles.runs}>
      <StatusBadge status={status}>{fact.text}</StatusBadge>
    </p>
  );
}

/** The newest of the runs that used it, and how many there are where these are not all. */
function Runs({ used }: Pick<RowProps, "used">) {
  const { t } = useTranslation();
  if (used === undefined) return null;
  if (used === null) return <p className={styles.runs}>{t("history.no_runs")}</p>;
  return (
    <p className={styles.runs}>
      {used.newest.map((run) => (
        <Link key={run.id} className={styles.link} to={`/runs/${run.id}`}>
          <StatusBadge status={statusOfRun(run)}>{t("history.run", { number: run.number })}</StatusBadge>
        </Link>
      ))}
      {used.count > used.newest.length ? <span>{t("history.runs", { count: used.count })}</span> : null}
    </p>
  );
}

type Asks = "name" | "copy" | "run" | null;

function More({ version, program, site }: RowProps) {
  const { t } = useTranslation();
  const [asks, setAsks] = useState<Asks>(null);
  const close = () => setAsks(null);
  const draws = mayEdit(site.role);
  const file = `/api/programs/${program.id}/versions/${version.number}/export`;
  return (
    <>
      <Menu position="bottom-end" width={240}>
        <Menu.Target>
          <IconButton label={t("history.more", { number: version.number })}>
            <Ellipsis size={17} aria-hidden="true" />
          </IconButton>
        </Menu.Target>
        <Menu.Dropdown>
          {!mayOperate(site.role) ? null : (
            <Menu.Item leftSection={<Play size={15} />} onClick={() => setAsks("run")}>
              {t("history.run_it", { number: version.number })}
            </Menu.Item>
          )}
          {draws ? (
            <>
              <Menu.Item leftSection={<Pencil size={15} />} onClick={() => setAsks("name")}>
                {t("history.rename")}
              </Menu.Item>
              <Menu.Item leftSection={<Copy size={15} />} onClick={() => setAsks("copy")}>
                {t("history.copy")}
              </Menu.Item>
            </>
          ) : null}
          <Menu.Item component="a" href={file} leftSection={<FileJson size={15} />}>
            {t("history.export")}
          </Menu.Item>
          <Menu.Item component="a" href={`${file}?form=script`} leftSection={<FileCode size={15} />}>
            {t("history.export_script")}
          </Menu.Item>
        </Menu.Dropdown>
      </Menu>
      {asks === "name" ? <NameVersion {...{ version, program }} onClose={close} /> : null}
      {asks === "copy" ? <CopyVersion {...{ version, program }} onClose={close} /> : null}
      {asks === "run" ? <RunVersion {...{ version, program, site }} onClose={close} /> : null}
    </>
  );
}
