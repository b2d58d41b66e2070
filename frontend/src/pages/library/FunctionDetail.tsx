/** One function: what it takes, what it does, and how to use it. */
import { Button, Menu, Tabs } from "@mantine/core";
import { Copy, Download, GitFork, SquareFunction, X } from "lucide-react";
import { useTranslation } from "react-i18next";
import { useState } from "react";
import { Link, useSearchParams } from "react-router-dom";
import { useLibraryFunction, usePrograms } from "@/api/queries";
import type { LibraryFunction } from "@/api/types";
import { valueWords } from "@/program/words/libraryWords";
import { LoadProblem } from "@/shell/LoadProblem";
import { Chip } from "@/design/Chip";
import { Panel } from "@/design/Panel";
import { formatAgo, formatNumber } from "@/i18n/format";
import { SourceView } from "../devices/description/SourceView";
import pages from "../pages.module.css";
import { nameOf } from "../people";
import { useNow } from "@/design/useNow";
import { CopyToSite } from "./CopyToSite";
import { FitSection } from "./Fit";
import { FunctionPicture } from "./FunctionPicture";
import { ParameterType } from "./FunctionCard";
import { Sharing } from "./Sharing";
import { Uses } from "./Uses";
import { Versions } from "./Versions";
import styles from "./library.module.css";

function Parameters({ item }: { item: LibraryFunction }) {
  const { t } = useTranslation();
  if (item.parameters.length === 0) return <p className={pages.sub}>{t("library.noParameters")}</p>;
  return (
    <Panel className={pages.scroll}>
      <table className={pages.table}>
        <thead>
          <tr>
            {["parameter", "type", "default"].map((column) => (
              <th key={column} scope="col">
                {t(`library.column.${column}`)}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {item.parameters.map((parameter) => (
            <tr key={parameter.name}>
              <td>
                <code className={styles.strong}>{parameter.name}</code>
              </td>
              <td>
                <ParameterType parameter={parameter} />
              </td>
              <td>{parameter.default == null ? t("library.asks") : valueWords(JSON.stringify(parameter.default))}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </Panel>
  );
}

function UseInProgram({ slug, item }: { slug: string; item: LibraryFunction }) {
  const { t } = useTranslation();
  const programs = usePrograms(slug).data ?? [];
  const [copying, setCopying] = useState(false);
  return (
    <footer className={styles.foot}>
      <Button variant="default" leftSection={<Copy size={16} />} onClick={() => setCopying(true)}>
        {t("library.copy.action")}
      </Button>
      {copying ? <CopyToSite slug={slug} item={item} onClose={() => setCopying(false)} /> : null}
      <Menu position="top-end" width={240}>
        <Menu.Target>
          <Button leftSection={<Download size={16} />} disabled={programs.length === 0}>
            {t("library.use")}
          </Button>
        </Menu.Target>
        <Menu.Dropdown>
          <Menu.Label>{t("library.chooseProgram")}</Menu.Label>
          {programs.map((program) => (
            <Menu.Item key={program.id} component={Link} to={`/programs/${program.id}?import=${item.id}`}>
              {program.name}
            </Menu.Item>
          ))}
        </Menu.Dropdown>
      </Menu>
    </footer>
  );
}

function Origin({ slug, item }: { slug: string; item: LibraryFunction }) {
  const { t } = useTranslation();
  const { origin } = item;
  if (!origin) return null;
  const behind = origin.newest - origin.version;
  return (
    <p className={styles.origin}>
      <GitFork size={15} aria-hidden="true" />
      <Link to={`/sites/${slug}/library/${origin.id}?from=${origin.version}`}>
        {t(origin.site === item.site ? "library.madeFrom" : "library.madeFromSite", { ...origin })}
      </Link>
      <Chip tone={behind > 0 ? "warn" : "quiet"}>
        {behind > 0 ? t("library.behind", { count: behind }) : t("library.upToDate")}
      </Chip>
    </p>
  );
}

function Body({ slug, item }: { slug: string; item: LibraryFunction }) {
  const { t } = useTranslation();
  return (
    <div className={styles.body}>
      {item.description ? <p>{item.description}</p> : null}
      <Origin slug={slug} item={item} />
      <Panel className={styles.bigPicture}>
        <FunctionPicture item={item} />
      </Panel>
      <Parameters item={item} />
      <FitSection item={item} />
      <Sharing item={item} />
      {item.script ? (
        <section aria-labelledby="script">
          <h3 id="script" className={styles.section}>
            {t("library.script")}
          </h3>
          <Panel className={styles.script}>
            <SourceView text={item.script} dialect="script" label={t("library.script")} />
          </Panel>
        </section>
      ) : null}
    </div>
  );
}

export function FunctionDetail({ slug, item }: { slug: string; item: LibraryFunction }) {
  const { t } = useTranslation();
  const now = useNow();
  const full = useLibraryFunction(item.id, slug);
  const [asked] = useSearchParams();
  const shown = full.data ?? item;
  return (
    <aside className={styles.detail} aria-label={item.name}>
      <header className={styles.head}>
        <span className={styles.sign}>
          <SquareFunction size={20} aria-hidden="true" />
        </span>
        <div>
          <h2>{shown.name}</h2>
          <p>
            {[
              t("library.version", { version: shown.version }),
              nameOf(shown.author),
              shown.site === slug ? "" : shown.site,
              t("library.updated", { ago: formatAgo(shown.updated_at, now) }),
            ]
              .filter(Boolean)
              .join(", ")}
          </p>
        </div>
        <Link to={`/sites/${slug}/library`} aria-label={t("pages.close")} className={styles.close}>
          <X size={18} aria-hidden="true" />
        </Link>
      </header>
      {full.isLoadingError ? <LoadProblem error={full.error} again={() => void full.refetch()} /> : null}
      <Tabs defaultValue={asked.has("from") ? "versions" : "about"} className={styles.tabs} keepMounted={false}>
        <Tabs.List>
          <Tabs.Tab value="about">{t("library.tabs.about")}</Tabs.Tab>
          <Tabs.Tab value="versions" rightSection={<Chip>{formatNumber(shown.version)}</Chip>}>
            {t("library.tabs.versions")}
          </Tabs.Tab>
          <Tabs.Tab value="uses" rightSection={<Chip>{formatNumber(shown.used_in)}</Chip>}>
            {t("library.tabs.uses")}
          </Tabs.Tab>
        </Tabs.List>
        <Tabs.Panel value="about">
          <Body slug={slug} item={shown} />
        </Tabs.Panel>
        <Tabs.Panel value="versions">
          <Versions item={shown} />
        </Tabs.Panel>
        <Tabs.Panel value="uses">
          <Uses slug={slug} item={shown} />
        </Tabs.Panel>
      </Tabs>
      <UseInProgram slug={slug} item={shown} />
    </aside>
  );
}
