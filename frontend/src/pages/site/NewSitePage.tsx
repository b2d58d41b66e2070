/** A new site out of a ROS map: the .yaml and its image. */
import { Button, TextInput } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { Building2, Check, FileUp } from "lucide-react";
import { useState, type DragEvent, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { problemText } from "@/shell/LoadProblem";
import { PageShell } from "@/shell/PageShell";
import { api, ApiProblem } from "@/api/client";
import { keys, useMe } from "@/api/queries";
import type { Site } from "@/api/types";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { nameFrom, sortFiles, type MapFiles } from "./files";
import { Preview } from "./Preview";
import styles from "./newsite.module.css";

function useCreateSite() {
  const queries = useQueryClient();
  const navigate = useNavigate();
  return useMutation({
    mutationFn: ({ name, files }: { name: string; files: MapFiles }) => {
      const form = new FormData();
      form.set("name", name);
      if (files.yaml) form.set("yaml", files.yaml);
      if (files.image) form.set("image", files.image);
      return api.upload<Site>("/sites", form);
    },
    onSuccess: async (site) => {
      await queries.invalidateQueries({ queryKey: keys.sites });
      await queries.invalidateQueries({ queryKey: keys.me });
      await navigate(`/sites/${site.slug}/map`);
    },
  });
}

interface DropZoneProps {
  files: MapFiles;
  problem: string | null;
  choose: (files: readonly File[]) => void;
}

function DropZone({ files, problem, choose }: DropZoneProps) {
  const { t } = useTranslation();
  const [over, setOver] = useState(false);
  const drop = (event: DragEvent) => {
    event.preventDefault();
    setOver(false);
    choose([...event.dataTransfer.files]);
  };
  const parts = [
    ["yaml", files.yaml],
    ["image", files.image],
  ] as const;
  return (
    <div>
      <label
        className={styles.zone}
        data-over={over || undefined}
        data-problem={problem ? true : undefined}
        onDragOver={(event) => {
          event.preventDefault();
          setOver(true);
        }}
        onDragLeave={() => setOver(false)}
        onDrop={drop}
      >
        <FileUp size={22} aria-hidden="true" />
        <b>{t("pages.newSite.choose")}</b>
        <span>{t("pages.newSite.chooseText")}</span>
        <input
          type="file"
          multiple
          accept=".yaml,.yml,.pgm,.png"
          className="visually-hidden"
          aria-describedby={problem ? "map-problem" : undefined}
          // The same file chosen again, after it was mended, must count as a choice too.
          onClick={(event) => {
            event.currentTarget.value = "";
          }}
          onChange={(event) => choose([...(event.target.files ?? [])])}
        />
      </label>
      <ul className={styles.parts}>
        {parts.map(([part, file]) => (
          <li key={part} data-there={file ? true : undefined}>
            {file ? <Check size={15} aria-hidden="true" /> : <span className={styles.dot} />}
            {file ? file.name : t(`pages.newSite.missing.${part}`)}
          </li>
        ))}
      </ul>
      {problem ? (
        <p id="map-problem" className={styles.problem} role="alert">
          {problem}
        </p>
      ) : null}
    </div>
  );
}

function NoRight() {
  const { t } = useTranslation();
  return (
    <Panel>
      <EmptyState icon={<Building2 size={20} />} title={t("pages.newSite.noRight")} text={t("pages.home.askForSite")} />
    </Panel>
  );
}

export function NewSitePage() {
  const { t } = useTranslation();
  const me = useMe().data;
  return (
    <PageShell title={t("shell.site.add")}>{me?.may_create_sites === false ? <NoRight /> : <NewSite />}</PageShell>
  );
}

function NewSite() {
  const { t } = useTranslation();
  const [name, setName] = useState("");
  const [files, setFiles] = useState<MapFiles>({ yaml: null, image: null });
  const create = useCreateSite();
  const problem = create.isError ? problemText(create.error, t("shell.problem.screen")) : null;
  const aboutName = create.error instanceof ApiProblem && /name|site/.test(create.error.code);
  const choose = (chosen: readonly File[]) => {
    const sorted = sortFiles(files, chosen);
    setFiles(sorted);
    if (!name && sorted.yaml) setName(nameFrom(sorted.yaml.name));
    create.reset();
  };
  const submit = (event: FormEvent) => {
    event.preventDefault();
    create.mutate({ name: name.trim(), files });
  };
  return (
    <div className={styles.page}>
      <Panel className={styles.card}>
        <form onSubmit={submit} className={styles.form}>
          <div>
            <h2>{t("pages.newSite.title")}</h2>
            <p>{t("pages.newSite.text")}</p>
          </div>
          <DropZone files={files} problem={aboutName ? null : problem} choose={choose} />
          <TextInput
            label={t("pages.newSite.name")}
            placeholder={t("pages.newSite.namePlaceholder")}
            maxLength={100}
            value={name}
            error={aboutName ? problem : null}
            onChange={(event) => setName(event.target.value)}
          />
          <Button type="submit" size="md" disabled={!files.yaml || !name.trim()} loading={create.isPending}>
            {t("pages.newSite.create")}
          </Button>
        </form>
      </Panel>
      <Panel className={styles.side}>
        {files.image ? <Preview file={files.image} /> : <p>{t("pages.newSite.previewHere")}</p>}
      </Panel>
    </div>
  );
}
