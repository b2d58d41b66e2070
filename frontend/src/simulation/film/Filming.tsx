/** The recording is played from its beginning and filmed as the 3D view shows it: how far it is, and its end. */
import { Button, Modal, Select } from "@mantine/core";
import { Film as FilmIcon } from "lucide-react";
import { useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { clock } from "@/design/clock";
import { beginFilm, type Film, filmForm, saveFile } from "./film";
import styles from "./Filming.module.css";
import { SPEEDS } from "../speeds";

export interface FilmPlayer {
  t_s: number;
  playing: boolean;
  seek: (t_s: number) => void;
  setSpeed: (speed: number) => void;
  setPlaying: (playing: boolean) => void;
}

interface FilmingProps {
  rehearsal: string;
  duration_s: number;
  player: FilmPlayer;
  opened: boolean;
  onClose: () => void;
}

const USUAL_SPEED = 20;

/** The canvas of the 3D view; null where it is not there (yet). */
function canvasOf3D(): HTMLCanvasElement | null {
  return document.querySelector<HTMLCanvasElement>("[data-scene] canvas");
}

export function Filming({ rehearsal, duration_s, player, opened, onClose }: FilmingProps) {
  const { t } = useTranslation();
  const [speed, setSpeed] = useState(USUAL_SPEED);
  const [failed, setFailed] = useState(false);
  const { film, begin, finish, drop } = useFilm(rehearsal, player, duration_s);
  const close = () => {
    setFailed(false);
    onClose();
  };
  const start = () => {
    if (begin(speed)) close();
    else setFailed(true);
  };
  const able = filmForm() !== null;
  return (
    <>
      <Modal opened={opened && !film} onClose={close} title={t("simulation.film.title")} size={460}>
        <div className={styles.form}>
          <p>{t(able ? "simulation.film.about" : "simulation.film.unable")}</p>
          <Select
            label={t("simulation.film.speed")}
            data={SPEEDS.map((each) => ({
              value: String(each),
              label: t("simulation.film.lasts", { speed: each, time: clock(duration_s / each) }),
            }))}
            value={String(speed)}
            allowDeselect={false}
            onChange={(chosen) => setSpeed(Number(chosen))}
          />
          {failed ? <p role="alert">{t("simulation.film.no_picture")}</p> : null}
          <div className={styles.buttons}>
            <Button variant="default" onClick={close}>
              {t("editor.cancel")}
            </Button>
            <Button
              data-autofocus
              disabled={!able}
              leftSection={<FilmIcon size={16} aria-hidden="true" />}
              onClick={start}
            >
              {t("simulation.film.begin")}
            </Button>
          </div>
        </div>
      </Modal>
      {film ? (
        <div className={styles.strip} role="status">
          <span className={styles.light} aria-hidden="true" />
          <span>{t("simulation.film.under_way")}</span>
          <progress max={duration_s} value={player.t_s} aria-label={t("simulation.film.under_way")} />
          <Button size="xs" variant="default" onClick={finish}>
            {t("simulation.film.end_now")}
          </Button>
          <Button size="xs" variant="subtle" onClick={drop}>
            {t("editor.cancel")}
          </Button>
        </div>
      ) : null}
    </>
  );
}

/** A film under way is over when the recording is, and is saved then. */
function useFilm(rehearsal: string, player: FilmPlayer, duration_s: number) {
  const [film, setFilm] = useState<Film | null>(null);
  const running = useRef<Film | null>(null);
  const over = film !== null && player.t_s >= duration_s;
  const finish = () => {
    if (!film) return;
    player.setPlaying(false);
    running.current = null;
    setFilm(null);
    void film.end().then((content) => saveFile(content, `rehearsal-${rehearsal}.webm`));
  };
  const drop = () => {
    film?.drop();
    player.setPlaying(false);
    running.current = null;
    setFilm(null);
  };
  useEffect(() => {
    if (over) finish();
  });
  useEffect(() => () => running.current?.drop(), []);
  const begin = (speed: number): boolean => {
    const canvas = canvasOf3D();
    const begun = canvas && beginFilm(canvas);
    if (!begun) return false;
    player.seek(0);
    player.setSpeed(speed);
    player.setPlaying(true);
    running.current = begun;
    setFilm(begun);
    return true;
  };
  return { film, begin, finish, drop };
}
